// posevote recognize: which taught objects are in these pictures, videos, cameras?
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <set>

#include "command.hpp"
#include "database.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/image/frame_source.hpp"
#include "posevote/image/inputs.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/render/annotate.hpp"
#include "posevote/store/follower.hpp"
#include "prepared_recognizer.hpp"
#include "progress.hpp"
#include "rate_meter.hpp"
#include "recognition_table.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct RecognizeArguments {
  std::vector<std::string> inputs, settings;
  std::string database, annotate, preset = "default", features;
  int every = 1;
  bool json = false, live = false;
};

volatile std::sig_atomic_t interrupted = 0;

/// Makes an interrupt end the frame loops, so that what was found is said.
void catch_interrupt() {
  std::signal(SIGINT, [](int) {
    interrupted = 1;
    std::signal(SIGINT, SIG_DFL);
  });
}

/// The recogniser for a database, kept up to date with it.
class LiveRecognizer {
 public:
  explicit LiveRecognizer(const RecognizeArguments& arguments)
      : store_(open_database(arguments.database, Access::existing)),
        version_(store_->version()),
        recognizer_(make_recognizer(*store_, version_, store_->load(), options(arguments))) {
    if (recognizer_->models()->views().empty())
      print_error("database '" + store_->location() +
                  "' holds no objects yet, so none will be recognised; see posevote teach --help");
  }

  RecognitionResult recognize(const cv::Mat& image) { return recognizer_->recognize(image); }

  /// From now on takes over what others teach as soon as they do, without holding up a frame.
  void follow() {
    if (follower_) return;
    follower_ = std::make_unique<Follower>(
        store_, version_, [this](const auto& models) { recognizer_->set_models(models); });
  }

 private:
  RecognizeOptions options(const RecognizeArguments& arguments) const {
    RecognizeOptions options = make_preset(arguments.preset);
    choose_features(options.feature, store_.get(), arguments.features);
    apply_settings(list_options(options), arguments.settings);
    require_features(options.feature, *store_);
    return options;
  }

  std::shared_ptr<ObjectStore> store_;
  std::int64_t version_;
  std::unique_ptr<Recognizer> recognizer_;
  std::unique_ptr<Follower> follower_;
};

/// Prints results and writes annotated pictures.
class Reporter {
 public:
  explicit Reporter(const RecognizeArguments& arguments) : arguments_(arguments) {
    if (!arguments.annotate.empty()) make_folder(arguments.annotate);
  }

  void report(const std::string& path, const cv::Mat& image, const RecognitionResult& result,
              const Moment& moment = {}) {
    if (arguments_.json)
      print_json(path, result, moment);
    else if (moment.frame < 0)
      std::cout << picture_table(path, result);
    else
      std::cout << frame_line(moment, result);
    std::cout.flush();
    if (arguments_.annotate.empty()) return;
    const std::string file = annotated_path(path, moment);
    save_picture(file, annotate(image, result));
    if (!arguments_.json && moment.frame < 0) std::cout << "  drawn in " << file << "\n\n";
  }

  void report_error(const std::string& path, const std::string& error) const {
    if (arguments_.json) std::cout << to_line(error_json(path, error)) << std::endl;
    print_error(error);
  }

 private:
  static void print_json(const std::string& path, const RecognitionResult& result,
                         const Moment& moment) {
    Json json = to_json(result, path);
    if (moment.frame >= 0) {
      json["frame"] = moment.frame;
      json["time_s"] = moment.time_s;
      json["latency_ms"] = std::round(moment.latency_ms * 10) / 10;
      json["per_second"] = std::round(moment.per_second * 100) / 100;
    }
    std::cout << to_line(json) << '\n';
  }

  /// FOLDER/stem-recognized.jpg; a second picture of that name gets a number.
  std::string annotated_path(const std::string& path, const Moment& moment) {
    const std::filesystem::path folder(arguments_.annotate);
    std::string stem = std::filesystem::path(path).stem().string();
    std::ranges::replace(stem, ':', '-');
    if (moment.frame >= 0) {
      char number[32];
      std::snprintf(number, sizeof number, "-%06lld", static_cast<long long>(moment.frame));
      return (folder / (stem + number + "-recognized.jpg")).string();
    }
    std::string name = stem + "-recognized.jpg";
    for (int i = 2; !used_.insert(name).second; ++i)
      name = stem + "-" + std::to_string(i) + "-recognized.jpg";
    return (folder / name).string();
  }

  const RecognizeArguments& arguments_;
  std::set<std::string> used_;
};

void recognize_picture(const Input& input, LiveRecognizer& recognizer, Reporter& reporter,
                       RecognitionTotals& totals) {
  const cv::Mat image = load_picture(input.path).image;
  const RecognitionResult result = recognizer.recognize(image);
  totals.add(result);
  reporter.report(input.path, image, result);
}

std::unique_ptr<FrameSource> open_source(const Input& input, bool live) {
  const QuietCodecs quiet;
  if (input.kind == InputKind::camera) return open_camera(input.camera);
  auto video = open_video(input.path);
  return live ? newest_only(at_its_pace(std::move(video))) : std::move(video);
}

std::optional<Frame> next_frame(FrameSource& stream) {
  const QuietCodecs quiet;
  return stream.next();
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void recognize_stream(const Input& input, const RecognizeArguments& arguments,
                      LiveRecognizer& recognizer, Reporter& reporter, RecognitionTotals& totals) {
  const auto stream = open_source(input, arguments.live);
  recognizer.follow();
  ProgressBar progress(input.path, static_cast<std::size_t>(stream->length()));
  RecognitionTotals here;
  RateMeter rate;
  const auto start = std::chrono::steady_clock::now();
  while (!interrupted) {
    const auto frame = next_frame(*stream);
    if (!frame) break;
    progress.advance(static_cast<std::size_t>(frame->dropped) + 1);
    here.add_dropped(frame->dropped);
    if (frame->number % arguments.every != 0) continue;
    const RecognitionResult result = recognizer.recognize(frame->image);
    here.add(result);
    progress.clear();
    const double now_s = seconds_since(start);
    rate.count(now_s);
    const double latency_ms = 1000 * seconds_since(frame->arrived);
    here.add_latency(latency_ms);
    reporter.report(input.path, frame->image, result,
                    {frame->number, frame->time_s, latency_ms, rate.per_second(now_s)});
  }
  here.add_stream_time(seconds_since(start));
  if (here.pictures() == 0 && !interrupted)
    throw Error(ErrorCode::unreadable_image,
                "cannot read video '" + input.path + "': it holds no frames");
  totals.add(here);
}

void run(const RecognizeArguments& arguments, CommandContext& context) {
  LiveRecognizer recognizer(arguments);
  Reporter reporter(arguments);
  catch_interrupt();
  const auto attempt = [&](const std::string& path, const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      const bool of_the_input = error.code() == ErrorCode::unreadable_image ||
                                error.code() == ErrorCode::not_found ||
                                error.code() == ErrorCode::unsupported;
      if (!of_the_input) throw;
      reporter.report_error(path, error.what());
      context.exit_status = 1;
    }
  };
  std::vector<Input> inputs;
  RecognitionTotals totals;
  for (const std::string& argument : arguments.inputs) {
    if (interrupted) break;
    std::vector<Input> expanded;
    attempt(argument, [&] { expanded = expand_input(argument); });
    ProgressBar progress("recognising", expanded.size());
    for (const Input& input : expanded) {
      if (interrupted) break;
      progress.clear();
      attempt(input.path, [&] {
        if (input.kind == InputKind::image)
          recognize_picture(input, recognizer, reporter, totals);
        else
          recognize_stream(input, arguments, recognizer, reporter, totals);
      });
      if (input.kind == InputKind::image) progress.advance();
    }
  }
  if (!arguments.json && totals.pictures() > 1) std::cout << totals.summary();
}

}  // namespace

void add_recognize(CLI::App& app, CommandContext& context) {
  auto arguments = std::make_shared<RecognizeArguments>();
  CLI::App* command =
      add_command(app, "recognize", "Find taught objects in pictures, videos and camera streams",
                  "  posevote recognize scene.jpg\n"
                  "  posevote recognize pictures/ --annotate found/    draws what it found\n"
                  "  posevote recognize *.jpg --json > results.jsonl    one line for each picture\n"
                  "  posevote recognize clip.mp4 --every 10\n"
                  "  posevote recognize clip.mp4 --live    as it plays: frames that come too "
                  "early are dropped\n"
                  "  posevote recognize camera:0    until interrupted; always the newest frame\n\n"
                  "In the table, sure is the probability that the object is there, in that place; "
                  "confidence is the share\nof the features in its area that match it.");
  RecognizeArguments& a = *arguments;
  command
      ->add_option("INPUT", a.inputs,
                   "Pictures, folders of pictures, video files, camera:N for the N-th camera")
      ->required();
  command->add_flag("--json", a.json, "One line of JSON for each picture");
  command->add_option("--annotate", a.annotate, "Write pictures with what was found into FOLDER")
      ->type_name("FOLDER");
  command->add_option("--every", a.every, "Of videos and cameras, only every N-th frame")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--live", a.live,
                    "Play videos at their own pace; frames that come while one is looked at are "
                    "dropped, as with cameras");
  add_preset(*command, a.preset);
  add_features(*command, a.features);
  add_settings(*command, a.settings);
  add_database(*command, a.database);
  command->callback([arguments, &context] { run(*arguments, context); });
}

}  // namespace posevote::cli
