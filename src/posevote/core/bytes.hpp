// Bytes that are kept and read again: numbers, arrays, and a checksum over all of them.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

namespace posevote {

static_assert(std::endian::native == std::endian::little, "saved numbers are little-endian");

/// FNV-1a over words of 8 bytes (the rest byte by byte).
inline std::uint64_t hash_bytes(const char* data, std::size_t size,
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

/// Appends values as they lie in memory; a checksum of all before ends them.
class ByteWriter {
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

/// Reads what ByteWriter wrote; after the first thing that does not fit everything is empty.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : next_(bytes.data()), left_(bytes.size()) {}

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

/// Is the checksum at the end right?
[[nodiscard]] inline bool is_whole(const std::string& bytes) {
  std::uint64_t sum;
  if (bytes.size() < sizeof sum) return false;
  const std::size_t size = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + size, sizeof sum);
  return sum == hash_bytes(bytes.data(), size);
}

}  // namespace posevote
