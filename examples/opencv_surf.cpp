// Finds one picture in another with OpenCV's own matcher and homography, and posevote's SURF.
//   opencv_surf OBJECT SCENE
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <posevote/opencv.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: opencv_surf OBJECT SCENE\n"), 2;
  const cv::Mat object = cv::imread(argv[1]), scene = cv::imread(argv[2]);
  if (object.empty() || scene.empty()) return std::fprintf(stderr, "cannot read the pictures\n"), 1;

  const cv::Ptr<cv::Feature2D> surf = posevote::create_surf();
  std::vector<cv::KeyPoint> object_points, scene_points;
  cv::Mat object_rows, scene_rows;
  surf->detectAndCompute(object, cv::noArray(), object_points, object_rows);
  surf->detectAndCompute(scene, cv::noArray(), scene_points, scene_rows);

  std::vector<std::vector<cv::DMatch>> nearest;
  if (!object_rows.empty() && scene_rows.rows > 1)
    cv::BFMatcher(surf->defaultNorm()).knnMatch(object_rows, scene_rows, nearest, 2);
  std::vector<cv::Point2f> from, to;
  for (const auto& match : nearest)
    if (match[0].distance < 0.8F * match[1].distance) {
      from.push_back(object_points[match[0].queryIdx].pt);
      to.push_back(scene_points[match[0].trainIdx].pt);
    }
  cv::Mat inliers, homography;
  if (from.size() >= 4) homography = cv::findHomography(from, to, cv::RANSAC, 3, inliers);
  const int count = homography.empty() ? 0 : cv::countNonZero(inliers);
  std::printf("%zu and %zu key points, %zu matches, %d fit one view of the object\n",
              object_points.size(), scene_points.size(), from.size(), count);
  return count >= 15 ? 0 : 1;
}
