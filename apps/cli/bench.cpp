// posevote bench: how long does recognition take here?
#include <iostream>

#include "command.hpp"
#include "database.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/image/inputs.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/json/recognition_json.hpp"
#include "prepared_recognizer.hpp"
#include "progress.hpp"
#include "recognition_table.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct BenchArguments {
  std::vector<std::string> inputs, settings;
  std::string database, preset = "default";
  int repeat = 3;
  bool json = false;
};

Json totals_json(const RecognitionTotals& totals, const ModelSet& models, std::size_t pictures) {
  Json times = Json::array();
  for (const StageTimes& time : totals.times())
    times.push_back({{"detect", time.detect},
                     {"match", time.match},
                     {"vote", time.vote},
                     {"verify", time.verify},
                     {"total", time.total}});
  return {{"objects", models.objects().size()},
          {"views", models.views().size()},
          {"features", models.feature_count()},
          {"pictures", pictures},
          {"time_ms", std::move(times)}};
}

std::vector<cv::Mat> read_pictures(const std::vector<std::string>& inputs) {
  std::vector<cv::Mat> pictures;
  for (const std::string& argument : inputs)
    for (const Input& input : expand_input(argument)) {
      if (input.kind != InputKind::image)
        throw Error(ErrorCode::invalid_argument,
                    "bench takes pictures and folders only, not '" + argument + "'");
      pictures.push_back(load_picture(input.path).image);
    }
  return pictures;
}

/// At most `limit` of the pictures that objects were taught from, spread over all objects.
std::vector<cv::Mat> taught_pictures(const ObjectStore& store, std::size_t limit) {
  const QuietCodecs quiet;
  std::vector<cv::Mat> pictures;
  for (std::size_t round = 0;; ++round) {
    const std::size_t before = pictures.size();
    for (const ObjectSummary& object : store.list()) {
      const auto views = store.views(object.name);
      if (round >= views.size()) continue;
      if (pictures.size() == limit) return pictures;
      pictures.push_back(
          decode_image(store.view(object.name, views[round].id).picture, store.location()));
    }
    if (pictures.size() == before) return pictures;
  }
}

void run(const BenchArguments& arguments) {
  const auto store = open_database(arguments.database, Access::existing);
  RecognizeOptions options = make_preset(arguments.preset);
  choose_features(options.feature, store.get(), "");
  apply_settings(list_options(options), arguments.settings);
  require_features(options.feature, *store);
  constexpr std::size_t enough = 20;
  const std::vector<cv::Mat> pictures =
      arguments.inputs.empty() ? taught_pictures(*store, enough) : read_pictures(arguments.inputs);
  if (pictures.empty())
    throw Error(ErrorCode::not_found, "database '" + store->location() +
                                          "' holds no pictures to time; teach an object first");
  const std::int64_t version = store->version();
  const auto opened = make_recognizer(*store, version, store->load(), options);
  const Recognizer& recognizer = *opened;
  static_cast<void>(recognizer.recognize(pictures.front()));  // warms up
  RecognitionTotals totals;
  ProgressBar progress("timing", pictures.size() * static_cast<std::size_t>(arguments.repeat));
  for (int i = 0; i < arguments.repeat; ++i)
    for (const cv::Mat& picture : pictures) {
      totals.add(recognizer.recognize(picture));
      progress.advance();
    }
  progress.clear();
  const auto models = recognizer.models();
  if (arguments.json) {
    std::cout << to_line(totals_json(totals, *models, pictures.size())) << '\n';
    return;
  }
  std::cout << models->objects().size() << " objects, " << models->views().size() << " views, "
            << models->feature_count() << " features; " << pictures.size() << " pictures, "
            << arguments.repeat << " times each\n\n"
            << totals.steps_table();
}

}  // namespace

void add_bench(CLI::App& app, CommandContext&) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = add_command(
      app, "bench", "Time recognition on pictures, step by step like the paper's Table I",
      "  posevote bench scenes/ --repeat 10\n"
      "  posevote bench    on the pictures that the objects were taught from");
  BenchArguments& a = *arguments;
  command->add_option("IMAGE", a.inputs, "Pictures or folders; none: those in the database");
  command->add_option("--repeat", a.repeat, "How many times each picture is recognised")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--json", a.json, "One line of JSON");
  add_preset(*command, a.preset);
  add_settings(*command, a.settings);
  add_database(*command, a.database);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace posevote::cli
