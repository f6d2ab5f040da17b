#include "logic/tracks.hpp"

#include <algorithm>

namespace posevote::logic {
namespace {

double overlap(const cv::Rect2d& a, const cv::Rect2d& b) {
  const double common = (a & b).area();
  return common > 0 ? common / (a.area() + b.area() - common) : 0;
}

}  // namespace

void TrackOptions::describe(OptionList& list) {
  list.add("confirm_after", confirm_after, {1, 1000}, "",
           "Pictures in which an instance must be seen before it is confirmed.");
  list.add("forget_after", forget_after, {1, 100000}, "",
           "Pictures in a row without an instance after which it is forgotten.");
  list.add("min_overlap", min_overlap, {0, 1}, "",
           "Overlap (intersection over union) of two boxes that are one instance.");
}

Tracker::Tracker(const TrackOptions& options) {
  set_options(options);
}

void Tracker::set_options(const TrackOptions& options) {
  validate_options(options);
  options_ = options;
}

/// For each sighting the index into `followed_`, or -1.
std::vector<int> Tracker::assign(const std::vector<Sighting>& sightings) const {
  struct Pair {
    double overlap;
    std::size_t sighting, followed;
  };
  std::vector<Pair> pairs;
  for (std::size_t s = 0; s < sightings.size(); ++s)
    for (std::size_t f = 0; f < followed_.size(); ++f) {
      if (sightings[s].object != followed_[f].last.object) continue;
      const double common = overlap(sightings[s].box, followed_[f].last.box);
      if (common > 0 && common >= options_.min_overlap) pairs.push_back({common, s, f});
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.overlap > b.overlap; });

  std::vector<int> assigned(sightings.size(), -1);
  std::vector<bool> taken(followed_.size(), false);
  for (const Pair& pair : pairs)
    if (assigned[pair.sighting] < 0 && !taken[pair.followed]) {
      assigned[pair.sighting] = static_cast<int>(pair.followed);
      taken[pair.followed] = true;
    }

  for (std::size_t s = 0; s < sightings.size(); ++s) {
    const std::string& object = sightings[s].object;
    const auto seen = std::count_if(sightings.begin(), sightings.end(),
                                    [&](const Sighting& other) { return other.object == object; });
    const auto is_known = [&](const Followed& other) { return other.last.object == object; };
    const auto known = std::count_if(followed_.begin(), followed_.end(), is_known);
    if (assigned[s] < 0 && seen == 1 && known == 1)
      assigned[s] = static_cast<int>(std::find_if(followed_.begin(), followed_.end(), is_known) -
                                     followed_.begin());
  }
  return assigned;
}

int Tracker::free_place(const std::string& object) const {
  for (int place = 1;; ++place)
    if (std::none_of(followed_.begin(), followed_.end(), [&](const Followed& other) {
          return other.last.object == object && other.track.place == place;
        }))
      return place;
}

std::vector<Track> Tracker::update(const std::vector<Sighting>& sightings) {
  const std::vector<int> assigned = assign(sightings);
  for (Followed& followed : followed_) ++followed.missed;
  std::vector<Track> tracks;
  for (std::size_t s = 0; s < sightings.size(); ++s) {
    if (assigned[s] < 0) {
      Followed fresh;
      fresh.track = {next_id_++, free_place(sightings[s].object), false};
      followed_.push_back(fresh);
    }
    Followed& followed =
        assigned[s] < 0 ? followed_.back() : followed_[static_cast<std::size_t>(assigned[s])];
    followed.last = sightings[s];
    followed.missed = 0;
    ++followed.seen;
    followed.track.confirmed |= followed.seen >= options_.confirm_after;
    tracks.push_back(followed.track);
  }
  followed_.erase(std::remove_if(followed_.begin(), followed_.end(),
                                 [this](const Followed& followed) {
                                   return followed.missed >= options_.forget_after;
                                 }),
                  followed_.end());
  return tracks;
}

std::string track_frame(const std::string& prefix, const std::string& object, const Track& track) {
  return prefix + object + "_" + std::to_string(track.place);
}

}  // namespace posevote::logic
