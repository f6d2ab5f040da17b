#include "posevote/store/content_hash.hpp"

#include <gmock/gmock.h>

namespace posevote {
namespace {

std::string hash_of(const std::vector<std::string>& parts) {
  ContentHash hash;
  for (const std::string& part : parts) hash.add(part);
  return hash.hex();
}

TEST(ContentHash, NothingHasTheKnownHash) {
  EXPECT_EQ(hash_of({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(ContentHash, BordersBetweenPartsCount) {
  EXPECT_EQ(hash_of({"ab", "c"}), hash_of({"ab", "c"}));
  EXPECT_NE(hash_of({"ab", "c"}), hash_of({"a", "bc"}));
  EXPECT_NE(hash_of({""}), hash_of({}));
}

}  // namespace
}  // namespace posevote
