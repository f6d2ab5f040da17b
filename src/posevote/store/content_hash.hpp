// SHA-256 over a sequence of parts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace posevote {

/// Each part counts with its length, so that ("ab", "c") and ("a", "bc") differ.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();

  void add(const void* data, std::size_t size);
  void add(const std::vector<std::uint8_t>& part) { add(part.data(), part.size()); }
  void add(const std::string& part) { add(part.data(), part.size()); }

  /// 64 lower-case hex digits; ends the hash.
  [[nodiscard]] std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace posevote
