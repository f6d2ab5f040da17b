// posevote objects rebuild: features are made again from the kept pictures and masks.
#include <iostream>

#include "database.hpp"
#include "objects.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/teach/teacher.hpp"
#include "progress.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct RebuildArguments {
  std::string database, features;
  std::vector<std::string> settings;
};

cv::Mat decode(const std::vector<std::uint8_t>& data, const std::string& name) {
  const QuietCodecs quiet;
  return data.empty() ? cv::Mat() : decode_image(data, name);
}

Features make_features(const cv::Mat& picture, const cv::Mat& mask, const TeachOptions& options) {
  if (mask.empty()) return make_extractor(options.feature)->extract(picture);
  ViewSource source;
  source.picture = picture;
  source.mask = mask;
  return teach_view(source, options).features;
}

/// The features that are asked for: the database's own unless something else is named.
TeachOptions rebuild_options(const RebuildArguments& arguments, const ObjectStore& store) {
  TeachOptions options;
  if (const auto record = store.features()) options.feature = parse_settings(*record);
  if (!arguments.features.empty() && arguments.features != options.feature.kind) {
    options.feature = FeatureOptions();
    options.feature.kind = arguments.features;
  }
  apply_settings(list_options(options), arguments.settings, "teach.");
  return options;
}

void run(const RebuildArguments& arguments, CommandContext& context) {
  const auto store = open_database(arguments.database, Access::existing);
  const TeachOptions options = rebuild_options(arguments, *store);
  std::size_t total = store->impostors().size(), views = 0, poor = 0;
  for (const ObjectSummary& object : store->list()) total += static_cast<std::size_t>(object.views);
  ProgressBar progress("rebuilding", total);
  store->rebuild(record_features(options.feature), [&](const auto& picture, const auto& mask) {
    progress.advance();
    ++views;
    try {
      return make_features(decode(picture, store->location()), decode(mask, store->location()),
                           options);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::unusable_view) throw;
      ++poor;  // kept: other features may suit it better
      return Features();
    }
  });
  progress.clear();
  std::cout << views << " views have features " << options.feature.signature() << " now\n";
  if (poor == 0) return;
  print_error(std::to_string(poor) + " views have too few features of this kind to be recognised");
  context.exit_status = 1;
}

}  // namespace

void add_rebuild(CLI::App& objects, CommandContext& context) {
  auto arguments = std::make_shared<RebuildArguments>();
  CLI::App* command = add_command(
      objects, "rebuild", "Make all features again, e.g. of another kind, from the kept pictures",
      "  posevote objects rebuild --features sift\n"
      "  posevote objects rebuild --set feature.max_features=500");
  add_features(*command, arguments->features);
  add_settings(*command, arguments->settings);
  add_database(*command, arguments->database);
  command->callback([arguments, &context] { run(*arguments, context); });
}

}  // namespace posevote::cli
