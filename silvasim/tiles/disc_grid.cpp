#include "silvasim/tiles/disc_grid.h"

#include <algorithm>

namespace silvasim::tiles {

DiscGrid::DiscGrid(const base::Box& window, double most_radius, double gap, double spacing)
    : window_(window), bounds_(base::grown(window, 2 * most_radius)), most_radius_(most_radius), gap_(gap) {
  cell_ = std::clamp(spacing, most_radius / 8, most_radius);
  columns_ = static_cast<int>(bounds_.width() / cell_) + 1;
  rows_ = static_cast<int>(bounds_.height() / cell_) + 1;
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
}

int DiscGrid::column(double x) const {
  return static_cast<int>(std::clamp((x - bounds_.west) / cell_, 0.0, columns_ - 1.0));
}

int DiscGrid::row(double y) const {
  return static_cast<int>(std::clamp((y - bounds_.south) / cell_, 0.0, rows_ - 1.0));
}

bool DiscGrid::cell_fits(int column, int row, const Disc& disc) const {
  const std::size_t cell =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  for (std::int32_t i = first_[cell]; i >= 0; i = entries_[static_cast<std::size_t>(i)].next) {
    const Disc& other = entries_[static_cast<std::size_t>(i)].disc;
    const double dx = other.x - disc.x, dy = other.y - disc.y, apart = other.radius + disc.radius + gap_;
    if (dx * dx + dy * dy < apart * apart) return false;
  }
  return true;
}

bool DiscGrid::fits(const Disc& disc) const {
  // Ask the disc's own cell first: most refusals come from there.
  const int own_column = column(disc.x), own_row = row(disc.y);
  if (!cell_fits(own_column, own_row, disc)) return false;
  const double reach = disc.radius + most_radius_ + gap_;
  const int west = column(disc.x - reach), east = column(disc.x + reach);
  const int south = row(disc.y - reach), north = row(disc.y + reach);
  for (int r = south; r <= north; ++r) {
    for (int c = west; c <= east; ++c) {
      if ((c != own_column || r != own_row) && !cell_fits(c, r, disc)) return false;
    }
  }
  return true;
}

void DiscGrid::insert(const Disc& disc) {
  const std::size_t cell = static_cast<std::size_t>(row(disc.y)) * static_cast<std::size_t>(columns_) +
                           static_cast<std::size_t>(column(disc.x));
  entries_.push_back({disc, first_[cell]});
  first_[cell] = static_cast<std::int32_t>(entries_.size()) - 1;
}

void DiscGrid::add(const Disc& disc) {
  insert(disc);
  // Repeat a disc near a rim beyond the opposite rim.
  const double near = 2 * most_radius_ + gap_;
  const double x =
      disc.x < window_.west + near ? window_.width() : (disc.x > window_.east - near ? -window_.width() : 0);
  const double y =
      disc.y < window_.south + near ? window_.height() : (disc.y > window_.north - near ? -window_.height() : 0);
  if (x != 0) insert({disc.x + x, disc.y, disc.radius});
  if (y != 0) insert({disc.x, disc.y + y, disc.radius});
  if (x != 0 && y != 0) insert({disc.x + x, disc.y + y, disc.radius});
}

}  // namespace silvasim::tiles
