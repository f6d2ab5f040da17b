#include "logic/node_options.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

std::set<std::string> names() {
  NodeOptions options;
  std::set<std::string> found;
  const OptionList list = list_options(options);
  for (const OptionField& field : list.fields())
    EXPECT_TRUE(found.insert(field.name).second) << field.name << " is there twice";
  return found;
}

TEST(NodeOptions, HoldTheLibrarysOwn) {
  RecognizeOptions library;
  const auto found = names();
  const OptionList list = list_options(library);
  for (const OptionField& field : list.fields()) EXPECT_TRUE(found.count(field.name)) << field.name;
  EXPECT_TRUE(found.count("teach.min_features"));
  EXPECT_TRUE(found.count("track.confirm_after"));
}

TEST(NodeOptions, HaveOneSetOfFeatureOptions) {
  for (const std::string& name : names()) EXPECT_NE(name.rfind("teach.feature.", 0), 0u) << name;
}

TEST(NodeOptions, SetTheFieldsTheyDescribe) {
  NodeOptions options;
  const OptionList list = list_options(options);
  list.set("teach.min_features", "12");
  list.set("feature.max_features", "500");
  list.set("publish_tf", "true");
  EXPECT_EQ(options.teach.min_features, 12);
  EXPECT_EQ(options.recognize.feature.max_features, 500);
  EXPECT_TRUE(options.publish_tf);
}

TEST(NodeOptions, AreIdentifiersWhenJoined) {
  for (const std::string& name : names())
    EXPECT_EQ(join_name(name, "__").find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
              std::string::npos)
        << name;
  EXPECT_EQ(join_name("feature.surf.octaves", "/"), "feature/surf/octaves");
}

TEST(DatabasePath, TakesWhatIsGivenThenTheEnvironment) {
  EXPECT_EQ(database_path("/x.db"), "/x.db");
  ASSERT_EQ(setenv("POSEVOTE_DB", "/named.db", 1), 0);
  EXPECT_EQ(database_path(""), "/named.db");
  ASSERT_EQ(unsetenv("POSEVOTE_DB"), 0);
  ASSERT_EQ(setenv("XDG_DATA_HOME", "/data", 1), 0);
  EXPECT_EQ(database_path(""), "/data/posevote/objects.db");
  ASSERT_EQ(unsetenv("XDG_DATA_HOME"), 0);
}

}  // namespace
}  // namespace posevote::logic
