"""Reads an ecosystem file by docs/ecosystem-file.md alone and prints what it holds as one JSON object.

Written from that document, not from Silva's sources: where the two disagree, a test fails. Floats are printed as the numbers
of their bits. Python's standard library has no zstd and no XXH3, so it borrows those of the system.

    python3 stranger.py forest.silva
"""
import ctypes
import json
import struct
import sys

zstd = ctypes.CDLL("libzstd.so.1")
zstd.ZSTD_decompress.restype = ctypes.c_size_t
zstd.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
xxhash = ctypes.CDLL("libxxhash.so.0")
xxhash.XXH3_64bits.restype = ctypes.c_uint64
xxhash.XXH3_64bits.argtypes = [ctypes.c_char_p, ctypes.c_size_t]


def xxh3(data):
    return xxhash.XXH3_64bits(data, len(data))


def unpack(codec, stored, size):
    if codec == 0:
        return stored
    out = ctypes.create_string_buffer(max(size, 1))
    assert zstd.ZSTD_decompress(out, size, stored, len(stored)) == size
    return out.raw[:size]


class Content:
    def __init__(self, data):
        self.data, self.at = data, 0

    def get(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values if len(values) > 1 else values[0]

    def text(self):
        size = self.get("I")
        self.at += size
        return self.data[self.at - size:self.at].decode("utf-8")


def chunks_of(data):
    assert data[:8] == b"\x89SILVA\r\n" and data[8:12] == b"\x04\x03\x02\x01"
    major, minor, check = struct.unpack_from("<HHQ", data, 12)
    assert (major, minor) == (1, 0) and check == xxh3(data[:16])
    table_at, count, zero, size, check = struct.unpack_from("<QIIQQ", data, len(data) - 40)
    assert data[-8:] == b"SILVAEND" and size == len(data) and zero == 0
    table = data[table_at:-40]
    assert len(table) == 56 * count and check == xxh3(data[:24] + table + data[-40:-16])
    end = 24
    for i in range(count):
        kind, flags, codec, zero, layer, first, rows, zero2, offset, stored, size, check = struct.unpack_from(
            "<4sHBBIIIIQQQQ", table, 56 * i)
        assert offset == end and zero == zero2 == 0
        end += stored
        piece = data[offset:end]
        assert xxh3(piece) == check
        if flags & 1 and kind != b"SUIT":
            continue
        yield kind.decode(), layer, first, rows, unpack(codec, piece, size)
    assert end == table_at


def heights(band, columns):
    n = len(band) // 4
    bits = []
    for i, planes in enumerate(zip(band[:n], band[n:2 * n], band[2 * n:3 * n], band[3 * n:])):
        folded = planes[0] | planes[1] << 8 | planes[2] << 16 | planes[3] << 24
        d = (folded >> 1) ^ (0xFFFFFFFF if folded & 1 else 0)
        west, north = i % columns != 0, i >= columns
        guess = 0
        if west and north:
            guess = bits[i - 1] + bits[i - columns] - bits[i - columns - 1]
        elif west:
            guess = bits[i - 1]
        elif north:
            guess = bits[i - columns]
        bits.append((guess + d) & 0xFFFFFFFF)
    return bits


def read(data):
    result, layers = {}, {}
    bands = {}
    for kind, number, first, rows, content in chunks_of(data):
        c = Content(content)
        layer = layers.setdefault(number, {}) if number != 0xFFFFFFFF else None
        if kind == "META":
            result["layer_count"] = c.get("I")
            result["extent"] = c.get("4Q")
            result["name"], result["crs_wkt"] = c.text(), c.text()
        elif kind == "PROV":
            result["provenance"] = content.decode("utf-8")
        elif kind == "TERR":
            result["grid"] = c.get("II4Q")
        elif kind == "LAYR":
            layer["name"] = c.text()
            layer["north_west"], layer["size"] = c.get("QQ"), c.get("II")
            layer["sites"], layer["probable"] = c.get("Q"), c.get("I")
        elif kind == "SPEC":
            layer["species"] = [[c.text(), c.text(), c.text(), *c.get("I4I"), c.get("Q")] for _ in range(c.get("I"))]
        elif kind == "TSET":
            layer["tile_set"] = c.get("QQII")
            layer["tiles"] = []
            for _ in range(c.get("I")):
                colours = c.get("4B")
                layer["tiles"].append([colours, [c.get("3I") for _ in range(c.get("I"))]])
        elif kind == "SUIT":
            layer["map"] = [*c.get("IIQQQ"), list(content[c.at:])]
            continue
        elif kind == "TLNG":
            layer["tiling"] = [n for n, in struct.iter_unpack("<H", content)]
        else:
            bands.setdefault((kind, number), []).append((first, rows, content))
            continue
        assert c.at == len(content) or kind in ("PROV", "TLNG")
    columns = result["grid"][0]
    result["heights"] = [h for _, _, b in bands.get(("HGTS", 0xFFFFFFFF), []) for h in heights(b, columns)]
    for number, layer in layers.items():
        wide = len(layer["species"]) >= 255
        layer["plants"] = []
        for _, _, band in bands.get(("PLNT", number), []):
            ids = (n for n, in struct.iter_unpack("<H" if wide else "<B", band))
            layer["plants"] += [-1 if n == (0xFFFF if wide else 0xFF) else n for n in ids]
        layer["probabilities"] = [n for _, _, b in bands.get(("PROB", number), []) for n, in struct.iter_unpack("<H", b)]
        assert len(layer["plants"]) == layer["sites"]
    result["layers"] = [layers[i] for i in range(result["layer_count"])]
    return result


if __name__ == "__main__":
    with open(sys.argv[1], "rb") as file:
        json.dump(read(file.read()), sys.stdout)
