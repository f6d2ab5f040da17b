// The bytes of Index::save: "PVIX", version, signature, dimension, the centres of each sign, the
// lists of each unit by its key, and a checksum of all before. Numbers are little-endian.
#include <bit>
#include <cstring>

#include "posevote/index/list_index.hpp"

namespace posevote {
namespace {

constexpr std::uint32_t kVersion = 1;  // raise it when the codes or the layout change
static_assert(std::endian::native == std::endian::little, "saved numbers are little-endian");

/// FNV-1a over words of 8 bytes (the rest byte by byte).
std::uint64_t hash_bytes(const char* data, std::size_t size,
                         std::uint64_t hash = 0xcbf29ce484222325) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (; size >= 8; data += 8, size -= 8) {
    std::uint64_t word;
    std::memcpy(&word, data, 8);
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 32;
  }
  for (; size > 0; ++data, --size) hash = (hash ^ static_cast<unsigned char>(*data)) * kPrime;
  return hash;
}

class Writer {
 public:
  template <class T>
  void value(T v) {
    bytes_.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <class T>
  void array(const T* values, std::size_t count) {
    value(static_cast<std::uint32_t>(count));
    if (count > 0) bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  [[nodiscard]] std::string finish() {
    value(hash_bytes(bytes_.data(), bytes_.size()));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

/// Reads what Writer wrote; after the first thing that does not fit everything is empty.
class Reader {
 public:
  explicit Reader(const std::string& bytes) : next_(bytes.data()), left_(bytes.size()) {}

  template <class T>
  T value() {
    T v{};
    if (take(sizeof v)) std::memcpy(&v, next_ - sizeof v, sizeof v);
    return v;
  }
  template <class Container>
  Container array() {
    using T = typename Container::value_type;
    const std::size_t count = value<std::uint32_t>();
    if (!take(count * sizeof(T)) || count == 0) return {};
    Container result(count, T{});
    std::memcpy(result.data(), next_ - count * sizeof(T), count * sizeof(T));
    return result;
  }
  [[nodiscard]] bool good() const noexcept { return good_; }

 private:
  bool take(std::size_t size) {
    good_ = good_ && size <= left_;
    if (good_) next_ += size;
    if (good_) left_ -= size;
    return good_;
  }

  const char* next_;
  std::size_t left_;
  bool good_ = true;
};

bool is_whole(const std::string& bytes) {
  std::uint64_t sum;
  if (bytes.size() < sizeof sum) return false;
  const std::size_t size = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + size, sizeof sum);
  return sum == hash_bytes(bytes.data(), size);
}

}  // namespace

std::uint64_t saved_key(const Unit& unit) {
  if (unit.view && !unit.view->hash.empty())
    return hash_bytes(unit.view->hash.data(), unit.view->hash.size());
  std::uint64_t hash = hash_bytes(reinterpret_cast<const char*>(unit.signs.data()), unit.size());
  for (int i = 0; i < unit.descriptors.rows; ++i)
    hash = hash_bytes(unit.descriptors.ptr<char>(i),
                      unit.descriptors.elemSize() * static_cast<std::size_t>(unit.descriptors.cols),
                      hash);
  return hash;
}

std::string ListIndex::save() const {
  Writer out;
  out.value(std::uint32_t{0x58495650});  // "PVIX"
  out.value(kVersion);
  out.array(signature_.data(), signature_.size());
  out.value(static_cast<std::uint32_t>(coder_.dimension()));
  for (std::size_t sign = 0; sign < kSigns; ++sign) {
    const Centers centers = quantizer_ ? (*quantizer_)[sign] : Centers();
    out.value(static_cast<std::uint32_t>(centers.count()));
    out.value(centers.member_scale());
    out.array(centers.codes().data(), centers.codes().size());
  }
  std::uint32_t units = 0;
  for (const Part& part : parts_)
    for (const Number& number : part.numbers) units += number.present;
  out.value(units);
  for (const Part& part : parts_)
    for (std::size_t u = 0; u < part.numbers.size(); ++u) {
      if (!part.numbers[u].present) continue;
      const Unit& unit = part.segment->units()[u];
      out.value(saved_key(unit));
      out.array(unit.lists.data(), unit.lists.size());
    }
  return out.finish();
}

SavedLists read_saved(const std::string& bytes, const std::string& signature, const Coder& coder) {
  if (!is_whole(bytes)) return {};
  Reader in(bytes);
  if (in.value<std::uint32_t>() != 0x58495650 || in.value<std::uint32_t>() != kVersion) return {};
  if (in.array<std::string>() != signature) return {};
  if (in.value<std::uint32_t>() != static_cast<std::uint32_t>(coder.dimension())) return {};
  auto quantizer = std::make_shared<Quantizer>();
  for (Centers& centers : *quantizer) {
    const std::size_t count = in.value<std::uint32_t>();
    const auto member_scale = in.value<float>();
    auto codes = in.array<std::vector<std::uint8_t>>();
    const std::size_t blocks = (count + kBlockLanes - 1) / kBlockLanes;
    if (count > 65536 || codes.size() != blocks * coder.block_bytes()) return {};
    if (!(member_scale >= kUnitScale && member_scale < 1e6F)) return {};
    centers = Centers(coder, count, std::move(codes), member_scale);
  }
  SavedLists result;
  const std::uint32_t units = in.value<std::uint32_t>();
  for (std::uint32_t u = 0; u < units && in.good(); ++u) {
    const auto key = in.value<std::uint64_t>();
    result.units[key] = in.array<std::vector<std::uint16_t>>();
  }
  if (in.good()) result.quantizer = std::move(quantizer);
  return result;
}

}  // namespace posevote
