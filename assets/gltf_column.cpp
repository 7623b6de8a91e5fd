#include <algorithm>
#include <bit>
#include <cstring>

#include "assets/gltf_parts.h"

namespace assets {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian, and are read as they are");

namespace {

constexpr std::size_t most_elements = 0x7FFFFFFF;

std::size_t bytes_of(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

int components_of(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;
  }
}

template <typename T>
T read(const unsigned char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

struct Bytes {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
  std::size_t stride = 0;  // 0: packed
};

Bytes view(const Reading& reading, const tinygltf::Model& model, int index, const std::string& what) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size()) {
    reading.fail(what + " uses buffer view " + std::to_string(index) + " of " +
                 std::to_string(model.bufferViews.size()));
  }
  const tinygltf::BufferView& v = model.bufferViews[static_cast<std::size_t>(index)];
  if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size()) {
    reading.fail(what + " uses buffer " + std::to_string(v.buffer) + " of " + std::to_string(model.buffers.size()));
  }
  const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(v.buffer)].data;
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset) {
    reading.fail(what + " lies in a buffer view that ends beyond its buffer of " + std::to_string(data.size()) +
                 " bytes");
  }
  return {data.data() + v.byteOffset, v.byteLength, v.byteStride};
}

// Checks that `count` elements of `bytes` each lie within `space` from `offset` on.
void check_within(const Reading& reading, const Bytes& space, std::size_t offset, std::size_t count, std::size_t stride,
                  std::size_t bytes, const std::string& what) {
  if (count == 0) return;
  const bool fits = offset <= space.size && bytes <= space.size - offset &&
                    (count - 1) <= (space.size - offset - bytes) / std::max<std::size_t>(stride, 1);
  if (!fits || stride == 0) {
    reading.fail(what + ": " + std::to_string(count) + " elements do not fit into their buffer view of " +
                 std::to_string(space.size) + " bytes");
  }
}

}  // namespace

Column::Column(const Reading& reading, const tinygltf::Model& model, int accessor, const std::string& what,
               int least_components, int most_components) {
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size()) {
    reading.fail(what + " uses accessor " + std::to_string(accessor) + " of " + std::to_string(model.accessors.size()));
  }
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  count_ = a.count;
  components_ = components_of(a.type);
  type_ = a.componentType;
  component_bytes_ = bytes_of(type_);
  normalised_ = a.normalized;
  if (components_ < least_components || components_ > most_components) {
    reading.fail(what + " has " + std::to_string(components_) + " components an element; it should have " +
                 std::to_string(least_components));
  }
  if (component_bytes_ == 0) reading.fail(what + " is of the unknown component type " + std::to_string(type_));
  if (count_ > most_elements) reading.fail(what + " has too many elements");
  const std::size_t element_bytes = component_bytes_ * static_cast<std::size_t>(components_);

  if (a.bufferView >= 0) {
    const Bytes space = view(reading, model, a.bufferView, what);
    stride_ = space.stride == 0 ? element_bytes : space.stride;
    check_within(reading, space, a.byteOffset, count_, stride_, element_bytes, what);
    data_ = count_ > 0 ? space.data + a.byteOffset : nullptr;
  }
  if (!a.sparse.isSparse) return;

  // Sparse: some elements stand elsewhere, told by ascending indices.
  if (a.sparse.count < 0 || a.sparse.indices.byteOffset < 0 || a.sparse.values.byteOffset < 0) {
    reading.fail(what + " is sparse with a negative number");
  }
  const auto replaced = static_cast<std::size_t>(a.sparse.count);
  const int index_type = a.sparse.indices.componentType;
  const std::size_t index_bytes = bytes_of(index_type);
  if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    reading.fail(what + " is sparse with indices of the wrong component type " + std::to_string(index_type));
  }
  const Bytes indices = view(reading, model, a.sparse.indices.bufferView, what);
  const Bytes values = view(reading, model, a.sparse.values.bufferView, what);
  const auto index_offset = static_cast<std::size_t>(a.sparse.indices.byteOffset);
  const auto value_offset = static_cast<std::size_t>(a.sparse.values.byteOffset);
  check_within(reading, indices, index_offset, replaced, index_bytes, index_bytes, what);
  check_within(reading, values, value_offset, replaced, element_bytes, element_bytes, what);
  sparse_.reserve(replaced);
  for (std::size_t i = 0; i < replaced; ++i) {
    const unsigned char* at = indices.data + index_offset + i * index_bytes;
    const std::uint32_t index = index_bytes == 1   ? *at
                                : index_bytes == 2 ? read<std::uint16_t>(at)
                                                   : read<std::uint32_t>(at);
    if (index >= count_ || (i > 0 && index <= sparse_.back())) {
      reading.fail(what + " is sparse with indices that do not ascend within its " + std::to_string(count_) +
                   " elements");
    }
    sparse_.push_back(index);
  }
  sparse_values_ = values.data + value_offset;
}

bool Column::is_unsigned() const {
  return !normalised_ &&
         (type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
          type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
}

const unsigned char* Column::element(std::size_t i) const {
  if (!sparse_.empty()) {
    const auto it = std::lower_bound(sparse_.begin(), sparse_.end(), i);
    if (it != sparse_.end() && *it == i) {
      const auto k = static_cast<std::size_t>(it - sparse_.begin());
      return sparse_values_ + k * component_bytes_ * static_cast<std::size_t>(components_);
    }
  }
  return data_ == nullptr ? nullptr : data_ + i * stride_;
}

float Column::number(std::size_t i, int component) const {
  const unsigned char* at = element(i);
  if (at == nullptr) return 0;
  at += component_bytes_ * static_cast<std::size_t>(component);
  const auto scaled = [this](float value, float greatest) {
    return normalised_ ? std::max(value / greatest, -1.0f) : value;
  };
  switch (type_) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return read<float>(at);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(read<std::int8_t>(at), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(*at, 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(read<std::int16_t>(at), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(read<std::uint16_t>(at), 65535.0f);
    default:
      return static_cast<float>(read<std::uint32_t>(at));
  }
}

std::uint32_t Column::index(std::size_t i) const {
  const unsigned char* at = element(i);
  if (at == nullptr) return 0;
  if (component_bytes_ == 1) return *at;
  return component_bytes_ == 2 ? read<std::uint16_t>(at) : read<std::uint32_t>(at);
}

}  // namespace assets
