#include "studio/teach_session.hpp"

#include <filesystem>

#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/store/object_name.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "posevote/teach/outline.hpp"
#include "studio/files.hpp"

namespace posevote::server {
namespace {

constexpr const char* kDraft = "draft";  // the object's name as long as it has none
constexpr std::size_t kMostRemoved = 16;

std::unique_ptr<ObjectStore> open_draft(const std::string& path) {
  SqliteOptions options;
  options.write_ahead = false;
  return open_sqlite_store(path, options);
}

/// 3 channels: whoever says "the whole picture" means it, whatever is transparent.
cv::Mat without_alpha(const cv::Mat& image) {
  return image.channels() == 4 ? to_bgr8(image) : image;
}

}  // namespace

Json Proposal::json() const {
  const double covered = mask.empty() ? 0 : cv::countNonZero(mask) / double(mask.total());
  Json json{{"usable", view.has_value()},
            {"method", method},
            {"source", picture.source},
            {"width", picture.image.cols},
            {"height", picture.image.rows},
            {"yaw", number_or_null(yaw_deg)},
            {"features", view ? view->features.size() : 0},
            {"coverage", covered},
            {"outline", points_json(mask.empty() ? std::vector<cv::Point2f>() : outline_of(mask))},
            {"quality", quality ? quality_json(*quality) : Json()},
            {"adds_little", quality && quality->redundancy > QualityOptions().redundant_from},
            {"advice", advice}};
  return json;
}

TeachSession::TeachSession(std::string id, std::string path, double wait_s, ObjectModel of)
    : id_(std::move(id)), path_(std::move(path)), of_(std::move(of)), looks_(1, wait_s) {
  if (!std::filesystem::exists(path_)) return;
  draft_ = open_draft(path_);
  measure_redundancies();
}

std::vector<ViewSummary> TeachSession::views() const {
  return draft_ && has_object(*draft_, kDraft) ? draft_->views(kDraft) : std::vector<ViewSummary>();
}

Json TeachSession::json() const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  const auto all = views();
  for (const ViewSummary& view : all) {
    const double redundancy = redundancies_.at(view.id);
    list.push_back(view_json(view));
    list.back()["redundancy"] = redundancy;
    list.back()["adds_little"] = redundancy > QualityOptions().redundant_from;
  }
  std::vector<double> known, yaws = yaws_of(all);
  for (const auto& view : of_.views)
    if (std::isfinite(view->yaw_deg)) known.push_back(view->yaw_deg);
  yaws.insert(yaws.end(), known.begin(), known.end());
  const Json next = next_yaw_json(yaws);
  return {{"session", id_},
          {"object", of_.name.empty() ? Json() : Json(of_.name)},
          {"known_yaws", known},
          {"seconds", seconds()},
          {"background", background_.has_value()},
          {"proposal", proposal_.has_value()},
          {"views", std::move(list)},
          {"next_yaw", next},
          {"enough", !yaws.empty() && next.is_null()}};
}

void TeachSession::touch() {
  if (discarded_) throw not_found("there is no such teach session any more");
  touched_ = Clock::now();
}

double TeachSession::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

double TeachSession::idle_s() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::duration<double>(Clock::now() - touched_).count();
}

void TeachSession::set_background(SentPicture background) {
  const std::lock_guard lock(mutex_);
  touch();
  background_ = std::move(background);
}

SentPicture TeachSession::background() const {
  const std::lock_guard lock(mutex_);
  if (!background_) throw not_found("this session has no background yet");
  return *background_;
}

TeachSession::Known TeachSession::known() const {
  Known known;
  known.views = of_.views;
  if (background_) known.background = background_->image;
  if (draft_ && has_object(*draft_, kDraft))
    for (const auto& view : draft_->load_object(kDraft).views) known.views.push_back(view);
  return known;
}

Proposal TeachSession::examine(SentPicture picture, const Wish& wish, const TeachOptions& options,
                               const Known& known) {
  ViewSource source;
  source.picture = wish.whole ? without_alpha(picture.image) : picture.image;
  source.yaw_deg = wish.yaw_deg;
  Proposal proposal;
  proposal.method = "whole";
  if (!wish.mask.empty()) {
    proposal.method = "mask";
    source.mask = wish.mask;
  } else if (wish.roi) {
    proposal.method = "roi";
    source.roi = wish.roi;
  } else if (!known.background.empty() && !wish.whole) {
    proposal.method = "background";
    source.background = known.background;
  }
  proposal.yaw_deg = wish.yaw_deg;
  proposal.picture = std::move(picture);
  try {
    proposal.mask = find_object(source, options.segment);
    source.mask = proposal.mask;
    View view = teach_view(source, options);
    QualityOptions quality;
    quality.feature = options.feature;
    proposal.quality = assess_view(view, known.views, quality);
    proposal.advice = proposal.quality->advice;
    proposal.view = std::move(view);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unusable_view) throw;
    proposal.advice = {error.what()};
  }
  return proposal;
}

Proposal TeachSession::propose(SentPicture picture, const Wish& wish, const TeachOptions& options) {
  Known known_now;
  {
    const std::lock_guard lock(mutex_);
    touch();
    known_now = known();
  }
  Proposal proposal = examine(std::move(picture), wish, options, known_now);
  const std::lock_guard lock(mutex_);
  touch();
  proposal_ = std::move(proposal);
  return *proposal_;
}

Proposal TeachSession::correct(const cv::Mat& mask, const TeachOptions& options) {
  const Proposal corrected = proposal();
  Wish wish;
  wish.mask = mask;
  wish.yaw_deg = corrected.yaw_deg;
  return propose(corrected.picture, wish, options);
}

Proposal TeachSession::proposal() const {
  const std::lock_guard lock(mutex_);
  if (!proposal_) throw not_found("there is no view in hand");
  return *proposal_;
}

void TeachSession::accept(std::optional<double> yaw_deg, const FeatureOptions& features,
                          const std::string& version) {
  const std::lock_guard lock(mutex_);
  touch();
  if (!proposal_) throw not_found("there is no view in hand");
  if (!proposal_->view) throw conflict("the view cannot be used: " + proposal_->advice.front());
  TaughtView taught;
  taught.view = *proposal_->view;
  if (yaw_deg) taught.view.yaw_deg = *yaw_deg;
  taught.picture = proposal_->picture.encoded;
  taught.method = proposal_->method;
  taught.provenance = {proposal_->picture.source, "", version};
  if (!draft_) draft_ = open_draft(path_);
  const AddResult result = draft_->add_view(kDraft, taught, record_features(features));
  if (!result.added) throw conflict("this very picture is among the views already");
  redundancies_[result.id] = proposal_->quality->redundancy;
  proposal_.reset();
}

TaughtView TeachSession::view(const std::string& view) const {
  const std::lock_guard lock(mutex_);
  if (!draft_) throw not_found("this session has no view '" + view + "'");
  return draft_->view(kDraft, view);
}

void TeachSession::remove_view(const std::string& view) {
  const std::lock_guard lock(mutex_);
  touch();
  if (!draft_) throw not_found("this session has no view '" + view + "'");
  TaughtView removed = draft_->view(kDraft, view);
  draft_->remove_view(kDraft, view);
  if (removed_.size() == kMostRemoved) removed_.erase(removed_.begin());
  removed_.insert_or_assign(view, std::move(removed));
  measure_redundancies();
}

void TeachSession::restore_view(const std::string& view) {
  const std::lock_guard lock(mutex_);
  touch();
  const auto at = removed_.find(view);
  if (at == removed_.end()) throw not_found("view '" + view + "' is not kept any more");
  draft_->add_view(kDraft, at->second, draft_->features().value());
  removed_.erase(at);
  measure_redundancies();
}

void TeachSession::measure_redundancies() {
  redundancies_.clear();
  if (!has_object(*draft_, kDraft)) return;
  std::vector<std::shared_ptr<const View>> before = of_.views;
  for (const auto& view : draft_->load_object(kDraft).views) {
    redundancies_[view->id] = measure_redundancy(*view, before);
    before.push_back(view);
  }
}

std::vector<AddResult> TeachSession::save(ObjectStore& store, const std::string& object,
                                          bool add_to_existing) const {
  check_object_name(object);
  const std::lock_guard lock(mutex_);
  if (views().empty()) throw conflict("there are no views to save yet; accept one first");
  std::vector<AddResult> results;
  store.transact([&] {
    if (!add_to_existing && has_object(store, object))
      throw Error(ErrorCode::already_exists,
                  "there is an object '" + object + "' already; add to it, or take another name");
    results = copy_views(*draft_, kDraft, store, object);
  });
  return results;
}

void TeachSession::discard() {
  const std::lock_guard lock(mutex_);
  discarded_ = true;
  draft_.reset();
  proposal_.reset();
  remove_database_file(path_);
}

}  // namespace posevote::server
