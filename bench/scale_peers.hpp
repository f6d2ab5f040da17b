// The searches of other libraries that bench_scale compares with.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace posevote::bench {

/// Rows of `queries` x k indices of rows of the database, nearest first, as CV_32S.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual cv::Mat search(const cv::Mat& queries, int k) const = 0;
};

struct PeerKind {
  std::string name;
  bool slow_search;  ///< time grows with the database: few queries are enough
  bool slow_build;
  std::function<std::unique_ptr<Peer>(const cv::Mat& database)> make;
};

/// Those that this build found.
[[nodiscard]] std::vector<PeerKind> peer_kinds();

}  // namespace posevote::bench
