// posevote teach: pictures of an object become its views.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "command.hpp"
#include "database.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/store/object_name.hpp"
#include "posevote/teach/quality.hpp"
#include "posevote/teach/teacher.hpp"
#include "progress.hpp"
#include "quality_cards.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct TeachArguments {
  std::string name, background, roi, features, database;
  std::vector<std::string> images, masks, settings;
  std::vector<double> yaws;
  bool whole = false, brief = false, skip_redundant = false;
};

/// What all pictures of one call have in common.
struct Lesson {
  cv::Mat background;
  std::optional<cv::Rect> roi;
  std::string method;
  TeachOptions options;
};

cv::Rect parse_roi(const std::string& text) {
  int values[4] = {};
  int used = -1;
  if (std::sscanf(text.c_str(), "%d,%d,%d,%d%n", &values[0], &values[1], &values[2], &values[3],
                  &used) != 4 ||
      used != static_cast<int>(text.size()) || values[2] < 1 || values[3] < 1)
    wrong_usage("--roi needs X,Y,WIDTH,HEIGHT in pixels, not '" + text + "'");
  return {values[0], values[1], values[2], values[3]};
}

void check_counts(const TeachArguments& arguments) {
  const std::string images = std::to_string(arguments.images.size());
  if (!arguments.masks.empty() && arguments.masks.size() != arguments.images.size())
    wrong_usage("there are " + std::to_string(arguments.masks.size()) + " masks for " + images +
                " pictures; give one mask for each, after all pictures");
  if (!arguments.yaws.empty() && arguments.yaws.size() != arguments.images.size())
    wrong_usage("there are " + std::to_string(arguments.yaws.size()) + " yaw angles for " + images +
                " pictures; give one for each, after all pictures");
}

Lesson prepare(const TeachArguments& arguments) {
  Lesson lesson;
  lesson.method = "whole";
  if (!arguments.roi.empty()) {
    lesson.roi = parse_roi(arguments.roi);
    lesson.method = "roi";
  }
  if (!arguments.masks.empty()) lesson.method = "mask";
  if (!arguments.background.empty()) {
    lesson.background = load_picture(arguments.background).image;
    lesson.method = "background";
  }
  return lesson;
}

/// 3 channels: whoever says "the whole picture" means it, whatever is transparent.
cv::Mat without_alpha(const cv::Mat& image) {
  if (image.channels() != 4) return image;
  cv::Mat opaque;
  cv::mixChannels(image, opaque = cv::Mat(image.size(), CV_MAKETYPE(image.depth(), 3)),
                  {0, 0, 1, 1, 2, 2});
  return opaque;
}

TaughtView make_view(const TeachArguments& arguments, std::size_t number, const Lesson& lesson) {
  LoadedPicture picture = load_picture(arguments.images[number]);
  ViewSource source;
  source.picture = arguments.whole ? without_alpha(picture.image) : picture.image;
  source.background = lesson.background;
  source.roi = lesson.roi;
  if (!arguments.masks.empty()) source.mask = load_picture(arguments.masks[number]).image;
  if (!arguments.yaws.empty()) source.yaw_deg = arguments.yaws[number];
  TaughtView taught;
  try {
    taught.view = teach_view(source, lesson.options);
  } catch (const Error& error) {
    throw Error(error.code(),
                "cannot teach from '" + arguments.images[number] + "': " + error.what());
  }
  taught.picture = std::move(picture.encoded);
  taught.method = lesson.method;
  taught.provenance = {arguments.images[number], "", POSEVOTE_VERSION};
  return taught;
}

void print(const std::string& name, const TaughtView& taught, const AddResult& result) {
  if (!result.added) {
    std::cout << name << ": " << taught.provenance.source << " is view " << result.id
              << " already\n";
    return;
  }
  const int percent = static_cast<int>(std::lround(100 * coverage(taught.view)));
  std::cout << name << ": view " << result.id << " from " << taught.provenance.source << ", "
            << taught.view.features.size() << " features, the object covers " << percent
            << " % of the picture\n";
}

std::vector<std::shared_ptr<const View>> views_of(const std::string& name, const ModelSet& models) {
  const auto object = std::ranges::find(models.objects(), name, &ObjectModel::name);
  return object == models.objects().end() ? std::vector<std::shared_ptr<const View>>{}
                                          : object->views;
}

/// How well the new views will be found, and what they could be mixed up with.
void print_cards(const std::string& name, const std::vector<std::shared_ptr<const View>>& views,
                 const ObjectStore& store, const FeatureOptions& features) {
  const auto models = store.load();
  QualityOptions options;
  options.feature = features;
  print_quality(views, views_of(name, *models), options, std::cout);
  print_resemblances(name, views, *models, features, std::cout);
}

/// Whether the object's other views know most of the view's features already; says so then.
bool is_redundant(const TaughtView& taught, const TeachArguments& arguments,
                  const std::vector<std::shared_ptr<const View>>& others,
                  const FeatureOptions& features) {
  QualityOptions options;
  options.feature = features;
  const double redundancy = measure_redundancy(taught.view, others, options);
  if (redundancy < options.redundant_from) return false;
  std::cout << arguments.name << ": " << taught.provenance.source << " is left out, "
            << std::lround(100 * redundancy) << " % of its features are known from other views\n";
  return true;
}

void run(const TeachArguments& arguments, CommandContext& context) {
  check_counts(arguments);
  check_object_name(arguments.name);
  // A new database is made with its first view, not before.
  std::unique_ptr<ObjectStore> store;
  if (database_exists(arguments.database))
    store = open_database(arguments.database, Access::create);
  TeachOptions options;
  choose_features(options.feature, store.get(), arguments.features);
  apply_settings(list_options(options), arguments.settings, "teach.");
  if (store) require_features(options.feature, *store);
  Lesson lesson = prepare(arguments);
  lesson.options = options;

  ProgressBar progress("teaching " + arguments.name, arguments.images.size());
  std::vector<std::shared_ptr<const View>> views, others;
  if (store && arguments.skip_redundant) others = views_of(arguments.name, *store->load());
  for (std::size_t i = 0; i < arguments.images.size(); ++i) {
    try {
      TaughtView taught = make_view(arguments, i, lesson);
      progress.clear();
      if (!arguments.skip_redundant || !is_redundant(taught, arguments, others, options.feature)) {
        if (!store) store = open_database(arguments.database, Access::create);
        const AddResult result =
            store->add_view(arguments.name, taught, record_features(options.feature));
        print(arguments.name, taught, result);
        if (result.added) {
          taught.view.id = result.id;
          const auto view = std::make_shared<const View>(std::move(taught.view));
          if (!arguments.brief) views.push_back(view);
          if (arguments.skip_redundant) others.push_back(view);
        }
      }
      std::cout.flush();
    } catch (const Error& error) {
      const bool of_the_picture = error.code() == ErrorCode::unreadable_image ||
                                  error.code() == ErrorCode::unusable_view ||
                                  error.code() == ErrorCode::invalid_argument;
      if (!of_the_picture) throw;
      progress.clear();
      print_error(error.what());
      context.exit_status = 1;
    }
    progress.advance();
  }
  progress.clear();
  if (!views.empty()) print_cards(arguments.name, views, *store, options.feature);
}

}  // namespace

void add_teach(CLI::App& app, CommandContext& context) {
  auto arguments = std::make_shared<TeachArguments>();
  CLI::App* command = add_command(
      app, "teach", "Teach an object from pictures of it; each picture becomes a view",
      "  posevote teach mug front.jpg side.jpg --background empty-table.jpg --yaw 0 30\n"
      "      one picture of the empty table, then the object on it, turned by 30 degrees each "
      "time;\n"
      "      neither the camera nor its exposure may change in between\n"
      "  posevote teach poster poster.jpg\n"
      "      the whole picture is the object (or what a transparent PNG shows)\n"
      "  posevote teach mug front.jpg side.jpg --mask front-mask.png side-mask.png\n"
      "  posevote teach label shelf.jpg --roi 120,80,200,150");
  TeachArguments& a = *arguments;
  command->add_option("NAME", a.name, "Name of the object; one that exists gets more views")
      ->required();
  command->add_option("IMAGE", a.images, "Pictures of the object")->required();
  auto* background =
      command
          ->add_option("--background", a.background,
                       "The same scene without the object: the difference is the object")
          ->type_name("IMAGE");
  auto* mask =
      command->add_option("--mask", a.masks, "A picture for each IMAGE, white where the object is")
          ->type_name("IMAGE");
  auto* roi = command->add_option("--roi", a.roi, "The object fills this rectangle of each IMAGE")
                  ->type_name("X,Y,W,H");
  auto* whole = command->add_flag("--whole", a.whole, "The object fills each IMAGE");
  for (auto* one : {background, mask, roi, whole})
    for (auto* other : {background, mask, roi, whole})
      if (one != other) one->excludes(other);
  command->add_option("--yaw", a.yaws, "Turn of the object about the vertical axis, for each IMAGE")
      ->type_name("DEG");
  command->add_flag("--skip-redundant", a.skip_redundant,
                    "Leave out pictures most of whose features the object's other views show");
  command->add_flag("--brief", a.brief,
                    "Do not rate the views: how well they will be found, what they look like");
  add_features(*command, a.features);
  add_settings(*command, a.settings);
  add_database(*command, a.database);
  command->callback([arguments, &context] { run(*arguments, context); });
}

}  // namespace posevote::cli
