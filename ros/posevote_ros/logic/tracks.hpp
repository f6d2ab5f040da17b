// The same instance in the next picture: numbers that stay, and names for tf.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"

namespace posevote::logic {

struct TrackOptions {
  int confirm_after = 2;     ///< pictures in which an instance was seen
  int forget_after = 5;      ///< pictures in a row in which it was not
  double min_overlap = 0.1;  ///< intersection over union of the boxes
  void describe(OptionList& list);
};

/// What tracking needs of a detection.
struct Sighting {
  std::string object;
  cv::Rect2d box;  ///< px
};

struct Track {
  std::uint32_t id = 0;    ///< from 1, never given twice
  int place = 0;           ///< from 1: the smallest number that no other instance of it holds
  bool confirmed = false;  ///< seen often enough; stays so until it is forgotten
};

/// Follows instances by object and place. Several pairs may go together: the one that overlaps most
/// goes first. An instance that moved too far to overlap is still the same when it is the only one
/// of its object, before and after. Not thread-safe.
class Tracker {
 public:
  explicit Tracker(const TrackOptions& options = {});

  /// A track for each sighting of the next picture, in their order.
  [[nodiscard]] std::vector<Track> update(const std::vector<Sighting>& sightings);

  void set_options(const TrackOptions& options);
  void reset() { followed_.clear(); }  ///< forgets all; numbers go on

 private:
  struct Followed {
    Track track;
    Sighting last;
    int seen = 0, missed = 0;
  };

  [[nodiscard]] std::vector<int> assign(const std::vector<Sighting>& sightings) const;
  [[nodiscard]] int free_place(const std::string& object) const;

  TrackOptions options_;
  std::vector<Followed> followed_;
  std::uint32_t next_id_ = 1;
};

/// The tf frame of an instance, e.g. "posevote/mug_1": stable as long as it is followed, different
/// for different instances.
[[nodiscard]] std::string track_frame(const std::string& prefix, const std::string& object,
                                      const Track& track);

}  // namespace posevote::logic
