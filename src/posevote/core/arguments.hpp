// Arguments as functions of C want them.
#pragma once

#include <string>
#include <vector>

namespace posevote {

/// Pointers to the words and a null pointer, for main-like functions and exec; as long as `words`
/// stay as they are.
[[nodiscard]] inline std::vector<char*> argv_of(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace posevote
