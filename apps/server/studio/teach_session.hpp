// One object on its way to be taught: background, the view in hand, the views accepted so far.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "posevote/teach/quality.hpp"
#include "posevote/teach/teacher.hpp"
#include "studio/catalogue.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {

/// What was asked for together with a picture.
struct Wish {
  cv::Mat mask;                 ///< empty: none
  std::optional<cv::Rect> roi;  ///< px
  bool whole = false;
  double yaw_deg = std::nan("");
};

/// A picture and what was found in it.
struct Proposal {
  SentPicture picture;
  std::string method;        ///< "background", "mask", "roi" or "whole"
  cv::Mat mask;              ///< empty: no object was found
  std::optional<View> view;  ///< empty: it cannot be used
  std::optional<ViewQuality> quality;
  std::vector<std::string> advice;  ///< why it cannot be used, or how it could be better
  double yaw_deg = std::nan("");

  [[nodiscard]] Json json() const;
};

/// Accepted views stand in a database of their own in `path`, one transaction each: they survive
/// whatever happens to the process. Safe for many threads.
class TeachSession {
 public:
  /// `path`: the database's file, which may be there from an earlier run. `of`: what is known of
  /// the object, when it gets further views.
  /// `wait_s`: how long a look waits for the one before it.
  TeachSession(std::string id, std::string path, double wait_s, ObjectModel of = {});

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] Json json() const;
  [[nodiscard]] double seconds() const;  ///< since it was begun
  [[nodiscard]] auto begun() const { return begun_; }
  [[nodiscard]] double idle_s() const;  ///< since it was last used

  void set_background(SentPicture background);
  [[nodiscard]] SentPicture background() const;  ///< throws Problem 404 without

  /// One look at a time: the turn of who calls `propose` or `correct`. It is taken before a place
  /// among the jobs, so that who waits for it keeps nobody else waiting.
  [[nodiscard]] JobSlots& looks() { return looks_; }

  /// Looks for the object; all else is answered meanwhile. What makes a picture unusable becomes
  /// the proposal's advice; throws Error{invalid_argument} for a mask of another size, a rectangle
  /// outside and the like.
  Proposal propose(SentPicture picture, const Wish& wish, const TeachOptions& options);
  /// The same picture again with this mask. Throws Problem 404 without a proposal.
  Proposal correct(const cv::Mat& mask, const TeachOptions& options);
  [[nodiscard]] Proposal proposal() const;  ///< throws Problem 404 without

  /// The proposal becomes a view, on the disk when this returns. Throws Problem 404 without one,
  /// 409 when it cannot be used or was there already.
  void accept(std::optional<double> yaw_deg, const FeatureOptions& features,
              const std::string& version);
  [[nodiscard]] TaughtView view(const std::string& view) const;  ///< throws 404
  void remove_view(const std::string& view);                     ///< throws 404
  /// Puts a view that was removed back, under a new id. Throws 404 for what is not kept any more.
  void restore_view(const std::string& view);

  /// Copies the views into `store`. Throws Error{already_exists} when there is such an object and
  /// `add_to_existing` is not set, Problem 409 when there are no views.
  [[nodiscard]] std::vector<AddResult> save(ObjectStore& store, const std::string& object,
                                            bool add_to_existing) const;

  /// Removes its file; from then on all others throw Problem 404, a look under way at its end.
  void discard();

 private:
  using Clock = std::chrono::steady_clock;

  /// What a look compares with.
  struct Known {
    cv::Mat background;  ///< empty: none
    std::vector<std::shared_ptr<const View>> views;
  };
  [[nodiscard]] Known known() const;
  static Proposal examine(SentPicture picture, const Wish& wish, const TeachOptions& options,
                          const Known& known);
  [[nodiscard]] std::vector<ViewSummary> views() const;
  void measure_redundancies();
  /// To be called, locked, by whatever changes it.
  void touch();

  const std::string id_, path_;
  const ObjectModel of_;  ///< unnamed: a new object
  Clock::time_point begun_ = Clock::now(), touched_ = begun_;
  JobSlots looks_;
  mutable std::mutex mutex_;
  std::optional<SentPicture> background_;
  std::optional<Proposal> proposal_;
  bool discarded_ = false;
  std::unique_ptr<ObjectStore> draft_;  ///< null as long as there are no views
  /// By view: the share of its features that the object's views and those taken before it know.
  std::map<std::string, double> redundancies_;
  std::map<std::string, TaughtView> removed_;  ///< those that may come back
};

}  // namespace posevote::server
