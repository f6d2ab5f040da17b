// Whole recognition by number of known objects: time, memory, start, teaching, right and false
// answers. The objects of a dataset stand in a database beside made ones, whose features are those
// of its views, moved.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "perturb.hpp"
#include "posevote/core/error.hpp"
#include "posevote/core/stopwatch.hpp"
#include "posevote/evaluate/dataset.hpp"
#include "posevote/evaluate/scorer.hpp"
#include "posevote/evaluate/statistics.hpp"
#include "posevote/store/open_store.hpp"
#include "posevote/teach/teacher.hpp"
#include "prepared_recognizer.hpp"
#include "scale_plot.hpp"

namespace {

using namespace posevote;
using nlohmann::json;

struct Settings {
  std::string dataset, folder,
      measured;  ///< measured: the database to measure, in a process of its own
  std::vector<int> objects{25, 1000};
  std::vector<double> deadlines;  ///< ms
  int views = 12, features_per_view = 180, tests = 40, scene_features = 1000, threads = 1;
};

FeatureOptions view_features(const Settings& settings) {
  FeatureOptions options;
  options.max_features = settings.features_per_view;
  return options;
}

/// The views of the dataset, object by object, with encoded pictures.
std::vector<std::vector<TaughtView>> teach(const Settings& settings, const Dataset& dataset) {
  std::vector<std::vector<TaughtView>> objects;
  TeachOptions options;
  options.feature = view_features(settings);
  for (const DatasetObject& object : dataset.objects) {
    auto& views = objects.emplace_back();
    for (const DatasetView& source : object.views) {
      if (static_cast<int>(views.size()) == settings.views) break;
      ViewSource view;
      view.picture = cv::imread(dataset.path(source.image).string());
      const auto& mask = source.mask.empty() ? source.truth_mask : source.mask;
      if (!mask.empty()) view.mask = cv::imread(dataset.path(mask).string(), cv::IMREAD_GRAYSCALE);
      view.yaw_deg = source.yaw_deg;
      TaughtView taught;
      taught.view = teach_view(view, options);
      taught.method = "mask";
      views.push_back(std::move(taught));
    }
  }
  return objects;
}

/// Another object that looks like it came from the same world; its pictures mean nothing.
TaughtView make_distractor(const TaughtView& source, cv::RNG& random) {
  static const std::vector<std::uint8_t> picture = [] {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", cv::Mat(8, 8, CV_8UC3, cv::Scalar(120, 130, 140)), bytes);
    return bytes;
  }();
  TaughtView made;
  made.view = source.view;
  made.view.features = bench::perturbed(source.view.features, random);
  made.view.picture = made.view.mask = cv::Mat();
  made.picture = picture;
  made.method = "made";
  made.view.yaw_deg = random.uniform(0.0, 360.0);
  return made;
}

void fill(const Settings& settings, const std::vector<std::vector<TaughtView>>& real,
          const Dataset& dataset, int count, const std::string& file) {
  std::filesystem::remove(file);
  const auto store = open_store(file);
  const FeatureRecord record = record_features(view_features(settings));
  cv::RNG random(1);
  store->transact([&] {
    for (int i = 0; i < count; ++i) {
      const std::size_t source = static_cast<std::size_t>(i) % real.size();
      const bool known = static_cast<std::size_t>(i) < real.size();
      const std::string name = known ? dataset.objects[source].name : "made " + std::to_string(i);
      for (const TaughtView& view : real[source])
        (void)store->add_view(name, known ? view : make_distractor(view, random), record);
    }
  });
}

double resident_mb(const char* field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field, 0) == 0)
      return std::stod(line.substr(std::string(field).size() + 1)) / 1024;
  return 0;
}

RecognizeOptions options_of(const Settings& settings) {
  RecognizeOptions options;
  options.threads = settings.threads;
  return options;
}

Score score(const RecognitionResult& found, const DatasetTest& test, const Dataset& dataset,
            cv::Size size) {
  std::vector<Claim> claims;
  for (const Detection& detection : found.detections)
    claims.push_back({detection.object, detection.box, detection.probability});
  return score_claims(claims, test, dataset, size);
}

/// Times of the scenes, once with `scene_features` and once with as many as are found by default.
json time_scenes(const Settings& settings, const Recognizer& recognizer, const Dataset& dataset) {
  json result;
  int asked = 0, right = 0, wrong = 0;
  std::vector<double> match, total, match_all, total_all;
  FeatureOptions few = recognizer.options().feature;
  few.max_features = settings.scene_features;
  few.surf.threads = settings.threads;
  const auto extractor = make_extractor(few);
  for (const DatasetTest& test : dataset.tests) {
    const cv::Mat image = cv::imread(dataset.path(test.image).string());
    for (int round = 0; round < 3; ++round) {
      Stopwatch watch;
      const Features scene = extractor->extract(image);
      const double detect_ms = watch.lap();
      const RecognitionResult found = recognizer.recognize(scene, image);
      match.push_back(found.time_ms.match);
      total.push_back(detect_ms + found.time_ms.total);
    }
    RecognitionResult found;
    for (int round = 0; round < 3; ++round) {
      found = recognizer.recognize(image);
      match_all.push_back(found.time_ms.match);
      total_all.push_back(found.time_ms.total);
    }
    const Score scored = score(found, test, dataset, image.size());
    asked += scored.asked;
    right += scored.right;
    wrong += scored.false_positives;
  }
  return {{"asked", asked},
          {"right", right},
          {"false_positives", wrong},
          {"match_1000_ms", median(match)},
          {"recognition_1000_ms", median(total)},
          {"match_ms", median(match_all)},
          {"recognition_ms", median(total_all)}};
}

/// What is found in so much time, and whether it is kept.
json time_deadlines(const Settings& settings, const std::shared_ptr<const ModelSet>& models,
                    const std::string& prepared, const Dataset& dataset) {
  json rows = json::array();
  for (const double deadline : settings.deadlines) {
    RecognizeOptions options = options_of(settings);
    options.deadline_ms = deadline;
    const Recognizer recognizer(models, options, prepared);
    int right = 0, wrong = 0, incomplete = 0;
    std::vector<double> total;
    for (const DatasetTest& test : dataset.tests) {
      const cv::Mat image = cv::imread(dataset.path(test.image).string());
      for (int round = 0; round < 3; ++round) {
        const RecognitionResult found = recognizer.recognize(image);
        total.push_back(found.time_ms.total);
        if (round > 0) continue;
        const Score scored = score(found, test, dataset, image.size());
        right += scored.right;
        wrong += scored.false_positives;
        incomplete += found.incomplete ? 1 : 0;
      }
    }
    rows.push_back({{"deadline_ms", deadline},
                    {"median_ms", median(total)},
                    {"longest_ms", *std::max_element(total.begin(), total.end())},
                    {"late", std::count_if(total.begin(), total.end(),
                                           [&](double ms) { return ms > 1.1 * deadline; })},
                    {"answers", total.size()},
                    {"incomplete", incomplete},
                    {"right", right},
                    {"false_positives", wrong}});
  }
  return rows;
}

/// Opens a database as a program does when it starts, and asks it.
json measure(const Settings& settings, const Dataset& dataset) {
  const cv::Mat first = cv::imread(dataset.path(dataset.tests.front().image).string());
  Stopwatch watch;
  const auto store = open_store(settings.measured, Access::existing);
  const std::int64_t version = store->version();
  auto models = store->load();
  const double load_ms = watch.lap();
  const auto recognizer = make_recognizer(*store, version, models, options_of(settings));
  const double prepare_ms = watch.lap();
  (void)recognizer->recognize(first);
  const double answer_ms = watch.lap();
  json result = time_scenes(settings, *recognizer, dataset);
  result["resident_mb"] = resident_mb("VmRSS:");
  result["peak_mb"] = resident_mb("VmHWM:");
  result["deadlines"] = time_deadlines(settings, models, recognizer->save_prepared(), dataset);
  cv::RNG random(3);
  const std::string name = models->objects().front().name;
  const TaughtView source = store->view(name, store->views(name).front().id);
  models.reset();
  watch.lap();
  (void)store->add_view(name, make_distractor(source, random), *store->features());
  recognizer->set_models(store->load());
  result["teach_ms"] = watch.lap();
  const ModelSet& now = *recognizer->models();
  result["objects"] = now.objects().size();
  result["views"] = now.views().size();
  result["descriptors"] = now.feature_count();
  result["load_ms"] = load_ms;
  result["prepare_ms"] = prepare_ms;
  result["first_answer_s"] = (load_ms + prepare_ms + answer_ms) / 1000;
  return result;
}

/// The output of this program for one database.
json measure_apart(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw Error(ErrorCode::io, "cannot run " + command);
  char buffer[4096];
  for (std::size_t size; (size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    text.append(buffer, size);
  pclose(pipe);
  return json::parse(text);
}

std::string draw(const json& rows) {
  const auto panel = [&](const std::string& title,
                         const std::vector<std::pair<std::string, std::string>>& fields) {
    bench::Panel result{title, {}};
    for (const auto& [field, name] : fields) {
      auto& curve = result.curves.emplace_back(bench::Curve{name, {}});
      for (const json& row : rows)
        curve.points.emplace_back(row["descriptors"].get<double>(), row[field].get<double>());
    }
    return result;
  };
  return bench::plot_svg("taught descriptors",
                         {panel("time of a picture, ms", {{"recognition_1000_ms", "1000 features"},
                                                          {"recognition_ms", "all features"}}),
                          panel("resident memory, MB", {{"resident_mb", "resident"}})});
}

int run(const Settings& settings, const std::string& program, const std::string& json_file,
        const std::string& svg_file) {
  const Dataset dataset = select_tests(load_dataset(settings.dataset), {}, settings.tests);
  if (!settings.measured.empty()) {
    std::cout << measure(settings, dataset).dump() << '\n';
    return 0;
  }
  const auto real = teach(settings, dataset);
  json rows = json::array();
  std::printf(
      "| objects | descriptors | match 1000, ms | recognition 1000, ms | recognition, ms | right | "
      "false | resident MB | first start s | start s | teach ms |\n"
      "|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const int count : settings.objects) {
    const std::string file =
        (std::filesystem::path(settings.folder) / ("objects-" + std::to_string(count) + ".db"))
            .string();
    fill(settings, real, dataset, count, file);
    std::ostringstream command;
    command << '"' << program << "\" --dataset \"" << settings.dataset << "\" --measure \"" << file
            << "\" --tests " << settings.tests << " --scene-features " << settings.scene_features
            << " --threads " << settings.threads;
    for (const double deadline : settings.deadlines) command << " --deadlines " << deadline;
    const json first = measure_apart(command.str());
    json row = measure_apart(command.str());
    row["first_start_s"] = first["first_answer_s"];
    rows.push_back(row);
    std::printf("| %d | %d | %.1f | %.1f | %.1f | %d of %d | %d | %.0f | %.2f | %.2f | %.0f |\n",
                row["objects"].get<int>(), row["descriptors"].get<int>(),
                row["match_1000_ms"].get<double>(), row["recognition_1000_ms"].get<double>(),
                row["recognition_ms"].get<double>(), row["right"].get<int>(),
                row["asked"].get<int>(), row["false_positives"].get<int>(),
                row["resident_mb"].get<double>(), row["first_start_s"].get<double>(),
                row["first_answer_s"].get<double>(), row["teach_ms"].get<double>());
    for (const json& of : row["deadlines"])
      std::printf(
          "within %.0f ms: median %.1f, longest %.1f ms, late by more than a tenth %d of %d; "
          "incomplete %d, right %d, false %d\n",
          of["deadline_ms"].get<double>(), of["median_ms"].get<double>(),
          of["longest_ms"].get<double>(), of["late"].get<int>(), of["answers"].get<int>(),
          of["incomplete"].get<int>(), of["right"].get<int>(), of["false_positives"].get<int>());
    std::fflush(stdout);
    std::filesystem::remove(file);
  }
  if (!json_file.empty()) std::ofstream(json_file) << rows.dump(2) << '\n';
  if (!svg_file.empty()) std::ofstream(svg_file) << draw(rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::string json_file, svg_file;
  CLI::App app("Whole recognition by number of known objects.");
  settings.dataset = POSEVOTE_SOURCE_DIR "/data/demo";
  settings.folder = std::filesystem::temp_directory_path().string();
  app.add_option("--dataset", settings.dataset, "Folder with dataset.json")->capture_default_str();
  app.add_option("--objects", settings.objects, "Numbers of objects")->delimiter(',');
  app.add_option("--views", settings.views, "Views of an object, at most");
  app.add_option("--per-view", settings.features_per_view, "Features of a view, at most; 0: all");
  app.add_option("--tests", settings.tests, "Test pictures, 0: all");
  app.add_option("--scene-features", settings.scene_features, "Of the first kind of scene");
  app.add_option("--threads", settings.threads, "Threads for one picture");
  app.add_option("--deadlines", settings.deadlines, "Also with so many ms for a picture")
      ->delimiter(',');
  app.add_option("--folder", settings.folder, "Where databases are made, and removed again");
  app.add_option("--measure", settings.measured, "Only measure this database; prints JSON");
  app.add_option("--svg", svg_file, "Draw the results in this file");
  app.add_option("--json", json_file, "Write the results to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings, argv[0], json_file, svg_file);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
