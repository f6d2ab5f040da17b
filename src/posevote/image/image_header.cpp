#include "posevote/image/image_header.hpp"

#include <array>
#include <cctype>
#include <cstring>

namespace posevote {
namespace {

struct EndOfData {};

/// Reads numbers at any place; throws EndOfData outside the data.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint32_t u8(std::size_t at) const {
    if (at >= size_) throw EndOfData();
    return data_[at];
  }
  [[nodiscard]] std::uint32_t be16(std::size_t at) const { return u8(at) << 8 | u8(at + 1); }
  [[nodiscard]] std::uint32_t be32(std::size_t at) const { return be16(at) << 16 | be16(at + 2); }
  [[nodiscard]] std::uint32_t le16(std::size_t at) const { return u8(at) | u8(at + 1) << 8; }
  [[nodiscard]] std::uint32_t le24(std::size_t at) const { return le16(at) | u8(at + 2) << 16; }
  [[nodiscard]] std::uint32_t le32(std::size_t at) const { return le16(at) | le16(at + 2) << 16; }
  [[nodiscard]] bool holds(std::size_t at, const char* text) const {
    const std::size_t length = std::strlen(text);
    return at <= size_ && size_ - at >= length && std::memcmp(data_ + at, text, length) == 0;
  }
  [[nodiscard]] Bytes part(std::size_t at, std::size_t length) const {
    if (at > size_ || size_ - at < length) throw EndOfData();
    return {data_ + at, length};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

cv::Size to_size(std::uint32_t width, std::uint32_t height) {
  constexpr std::uint32_t largest = 0x7fffffff;
  if (width > largest || height > largest) return {};
  return {static_cast<int>(width), static_cast<int>(height)};
}

/// The value of a SHORT or LONG tag in the first directory of TIFF data (Exif is TIFF, too).
std::optional<std::uint32_t> tiff_tag(const Bytes& bytes, std::uint32_t tag) {
  const bool big_endian = bytes.holds(0, "MM");
  const auto u16 = [&](std::size_t at) { return big_endian ? bytes.be16(at) : bytes.le16(at); };
  const auto u32 = [&](std::size_t at) { return big_endian ? bytes.be32(at) : bytes.le32(at); };
  if ((!big_endian && !bytes.holds(0, "II")) || u16(2) != 42) return std::nullopt;
  const std::size_t directory = u32(4);
  const std::uint32_t entries = u16(directory);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + std::size_t{12} * i;
    if (u16(entry) != tag) continue;
    return u16(entry + 2) == 3 ? u16(entry + 8) : u32(entry + 8);
  }
  return std::nullopt;
}

int exif_orientation(const Bytes& segment) {
  constexpr std::uint32_t orientation_tag = 274;
  constexpr std::size_t prefix = 6;  // "Exif" and two zeros
  if (!segment.holds(0, "Exif") || segment.size() < prefix) return 1;
  try {
    const auto value = tiff_tag(segment.part(prefix, segment.size() - prefix), orientation_tag);
    return value && *value >= 1 && *value <= 8 ? static_cast<int>(*value) : 1;
  } catch (const EndOfData&) {
    return 1;
  }
}

/// Position of the next marker's code at or after `at`: 0xFF and a byte that is neither stuffing,
/// fill nor a restart marker.
std::size_t next_marker(const Bytes& bytes, std::size_t at) {
  for (;; ++at) {
    if (bytes.u8(at) != 0xff) continue;
    const std::uint32_t code = bytes.u8(at + 1);
    if (code != 0x00 && code != 0xff && !(code >= 0xd0 && code <= 0xd7)) return at + 1;
  }
}

void read_jpeg(const Bytes& bytes, ImageHeader& header) {
  constexpr std::uint32_t end_of_image = 0xd9, exif = 0xe1;
  std::size_t at = 2;
  for (;;) {
    at = next_marker(bytes, at);
    const std::uint32_t code = bytes.u8(at);
    if (code == end_of_image) return;
    const std::size_t length = bytes.be16(at + 1);
    const bool start_of_frame =
        code >= 0xc0 && code <= 0xcf && code != 0xc4 && code != 0xc8 && code != 0xcc;
    if (start_of_frame && header.size.empty())
      header.size = to_size(bytes.be16(at + 6), bytes.be16(at + 4));
    if (code == exif && header.orientation == 1 && length >= 2)
      header.orientation = exif_orientation(bytes.part(at + 3, length - 2));
    at += 1 + length;
  }
}

void read_png(const Bytes& bytes, ImageHeader& header) {
  header.size = to_size(bytes.be32(16), bytes.be32(20));
  std::size_t at = 8;
  while (!bytes.holds(at + 4, "IEND")) at += std::size_t{12} + bytes.be32(at);
  static_cast<void>(bytes.part(at, 12));
}

void read_webp(const Bytes& bytes, ImageHeader& header) {
  if (bytes.holds(12, "VP8X")) {
    header.size = to_size(bytes.le24(24) + 1, bytes.le24(27) + 1);
  } else if (bytes.holds(12, "VP8L")) {
    const std::uint32_t bits = bytes.le32(21);
    header.size = to_size((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1);
  } else if (bytes.holds(12, "VP8 ")) {
    header.size = to_size(bytes.le16(26) & 0x3fff, bytes.le16(28) & 0x3fff);
  }
  header.complete = bytes.size() >= std::size_t{8} + bytes.le32(4);
}

void read_bmp(const Bytes& bytes, ImageHeader& header) {
  if (bytes.le32(14) == 12) {
    header.size = to_size(bytes.le16(18), bytes.le16(20));
    return;
  }
  const std::int64_t height = static_cast<std::int32_t>(bytes.le32(22));  // negative: top row first
  header.size = to_size(bytes.le32(18), static_cast<std::uint32_t>(std::abs(height)));
  const bool uncompressed = bytes.le32(30) == 0;
  const std::uint64_t row = (std::uint64_t{bytes.le16(28)} * bytes.le32(18) + 31) / 32 * 4;
  if (uncompressed &&
      row * static_cast<std::uint64_t>(std::abs(height)) + bytes.le32(10) > bytes.size())
    header.complete = false;
}

/// The next decimal number of a PNM header, after white space and comments; moves `at` behind it.
std::uint32_t pnm_number(const Bytes& bytes, std::size_t& at) {
  while (!std::isdigit(static_cast<int>(bytes.u8(at)))) {
    if (bytes.u8(at) == '#')
      while (bytes.u8(at) != '\n') ++at;
    ++at;
  }
  std::uint64_t number = 0;
  for (; std::isdigit(static_cast<int>(bytes.u8(at))); ++at)
    number = std::min<std::uint64_t>(number * 10 + bytes.u8(at) - '0', 0xffffffff);
  return static_cast<std::uint32_t>(number);
}

void read_pnm(const Bytes& bytes, ImageHeader& header) {
  const std::uint32_t kind = bytes.u8(1) - '0';
  std::size_t at = 2;
  const std::uint32_t width = pnm_number(bytes, at);
  const std::uint32_t height = pnm_number(bytes, at);
  header.size = to_size(width, height);
  if (kind < 4) return;  // text: the length is not known beforehand
  std::uint64_t row = (std::uint64_t{width} + 7) / 8;
  if (kind != 4)
    row = std::uint64_t{width} * (kind == 6 ? 3 : 1) * (pnm_number(bytes, at) > 255 ? 2 : 1);
  if (row != 0 && (bytes.size() - at - 1) / row < height) header.complete = false;
}

struct Format {
  const char* name;
  bool (*matches)(const Bytes&);
  void (*read)(const Bytes&, ImageHeader&);
};

void read_tiff(const Bytes& bytes, ImageHeader& header) {
  constexpr std::uint32_t width_tag = 256, height_tag = 257;
  header.size =
      to_size(tiff_tag(bytes, width_tag).value_or(0), tiff_tag(bytes, height_tag).value_or(0));
}

const std::array<Format, 6> formats{{
    {"jpeg", [](const Bytes& b) { return b.holds(0, "\xff\xd8\xff"); }, read_jpeg},
    {"png", [](const Bytes& b) { return b.holds(0, "\x89PNG\r\n\x1a\n") && b.holds(12, "IHDR"); },
     read_png},
    {"tiff", [](const Bytes& b) { return b.holds(0, "II*") || b.holds(0, "MM"); }, read_tiff},
    {"webp", [](const Bytes& b) { return b.holds(0, "RIFF") && b.holds(8, "WEBP"); }, read_webp},
    {"bmp", [](const Bytes& b) { return b.holds(0, "BM"); }, read_bmp},
    {"pnm",
     [](const Bytes& b) {
       return b.size() > 2 && b.u8(0) == 'P' && b.u8(1) >= '1' && b.u8(1) <= '6';
     },
     read_pnm},
}};

}  // namespace

std::optional<ImageHeader> parse_image_header(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, size);
  for (const Format& format : formats) {
    if (!format.matches(bytes)) continue;
    ImageHeader header;
    header.format = format.name;
    try {
      format.read(bytes, header);
    } catch (const EndOfData&) {
      header.complete = false;
    }
    if (header.size.empty()) return std::nullopt;
    return header;
  }
  return std::nullopt;
}

}  // namespace posevote
