#include "posevote/teach/teacher.hpp"

#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/teach/outline.hpp"
#include "posevote/teach/repeatable.hpp"
#include "posevote/teach/shortened.hpp"

namespace posevote {
namespace {

double white_of(const cv::Mat& image) {
  return image.depth() == CV_16U ? 65535 : 255;
}

// CV_8U 0/255: where a picture's only, or fourth, channel is above half.
cv::Mat above_half(const cv::Mat& image, int channel) {
  cv::Mat plane;
  cv::extractChannel(image, plane, channel);
  return plane > white_of(image) / 2;
}

cv::Mat from_mask(const ViewSource& source) {
  if (source.mask.size() != source.picture.size()) {
    throw Error(ErrorCode::invalid_argument, "the mask is " + size_text(source.mask) +
                                                 " but the picture " + size_text(source.picture) +
                                                 "; give a mask of the same size");
  }
  const cv::Mat bgr = to_bgr8(source.mask);
  return above_half(bgr, 0) | above_half(bgr, 1) | above_half(bgr, 2);
}

cv::Mat from_roi(const ViewSource& source) {
  const cv::Rect inside = *source.roi & cv::Rect(cv::Point(), source.picture.size());
  if (inside.empty()) {
    throw Error(ErrorCode::invalid_argument,
                "the rectangle lies outside the picture of " + size_text(source.picture));
  }
  cv::Mat mask = cv::Mat::zeros(source.picture.size(), CV_8U);
  mask(inside) = 255;
  return mask;
}

cv::Mat from_alpha_or_all(const cv::Mat& picture) {
  if (picture.channels() == 4) {
    cv::Mat opaque = above_half(picture, 3);
    if (cv::countNonZero(opaque) < static_cast<int>(picture.total())) return opaque;
  }
  return cv::Mat(picture.size(), CV_8U, cv::Scalar(255));
}

// Those of which `keeps(i)` is true.
template <class Keeps>
Features select(const Features& features, Keeps&& keeps) {
  Features kept;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!keeps(i)) continue;
    kept.keypoints.push_back(features.keypoints[i]);
    kept.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  return kept;
}

Features inside_border(const Features& features, const cv::Mat& mask, double border_scales) {
  // Beyond the picture there is nothing of the object either.
  cv::Mat framed, distance;
  cv::copyMakeBorder(mask, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return select(features, [&](std::size_t i) {
    const Keypoint& k = features.keypoints[i];
    const int x = std::clamp(cvRound(k.x), 0, mask.cols - 1);
    const int y = std::clamp(cvRound(k.y), 0, mask.rows - 1);
    return distance.at<float>(y + 1, x + 1) >= border_scales * k.scale;
  });
}

Features features_of(const cv::Mat& picture, const cv::Mat& mask, const Extractor& extractor,
                     const TeachOptions& options) {
  Features features = extractor.extract(picture, mask);
  if (!options.only_repeatable) return features;
  const auto repeats = find_repeatable(picture, mask, features, extractor);
  return select(features, [&](std::size_t i) { return repeats[i] != 0; });
}

// Both, each strongest first, in one such order.
Features merge(const Features& a, const Features& b) {
  Features merged;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool from_a =
        j == b.size() || (i < a.size() && a.keypoints[i].response >= b.keypoints[j].response);
    const Features& source = from_a ? a : b;
    const std::size_t row = from_a ? i++ : j++;
    merged.keypoints.push_back(source.keypoints[row]);
    merged.descriptors.push_back(source.descriptors.row(static_cast<int>(row)));
  }
  return merged;
}

Features features_inside(const cv::Mat& picture, const cv::Mat& mask, const TeachOptions& options) {
  cv::Mat seen = picture;
  if (options.paint_surroundings) {
    seen = picture.clone();
    seen.setTo(cv::mean(picture, mask), mask == 0);
  }
  const auto extractor = make_extractor(options.feature);
  Features features = features_of(seen, mask, *extractor, options);
  if (options.foreshortened) {
    const ShortenedPicture copy = shorten(seen, mask, 1, kFromAside);
    features = merge(features, lengthen(features_of(copy.picture, copy.mask, *extractor, options),
                                        copy.fx, copy.fy));
  }
  if (options.border_scales > 0) features = inside_border(features, mask, options.border_scales);
  return features;
}

}  // namespace

void TeachOptions::describe(OptionList& list) {
  list.group("feature", feature);
  list.group("segment", segment);
  list.add("min_features", min_features, {1, 1'000'000}, "",
           "A view with fewer features is refused.");
  list.add("border_scales", border_scales, {0, 20}, "",
           "Leave out features nearer to the silhouette than this many times their scale.");
  list.add("paint_surroundings", paint_surroundings,
           "Paint the surroundings in the object's mean colour before looking for features.");
  list.add("only_repeatable", only_repeatable,
           "Keep only features that are found again when the object is turned or farther off.");
  list.add("foreshortened", foreshortened,
           "Also keep the features that the object shows from 45 degrees above or below.");
}

cv::Mat find_object(const ViewSource& source, const SegmentOptions& options) {
  if (source.picture.empty()) throw Error(ErrorCode::invalid_argument, "the picture is empty");
  cv::Mat mask;
  if (!source.mask.empty())
    mask = from_mask(source);
  else if (!source.background.empty())
    return segment_by_background(source.picture, source.background, options);
  else if (source.roi)
    mask = from_roi(source);
  else
    mask = from_alpha_or_all(source.picture);
  if (cv::countNonZero(mask) == 0) {
    throw Error(ErrorCode::unusable_view, "the mask is empty; mark the object's pixels in white");
  }
  return mask;
}

View teach_view(const ViewSource& source, const TeachOptions& options) {
  validate_options(options);
  View view;
  view.picture = to_bgr8(source.picture);
  view.mask = find_object(source, options.segment);
  view.image_size = view.picture.size();
  view.yaw_deg = source.yaw_deg;
  view.outline = outline_of(view.mask);
  view.centre = centroid_of(view.mask);
  view.patch = make_patch(view.picture, view.mask);
  view.features = features_inside(view.picture, view.mask, options);
  if (view.features.size() < static_cast<std::size_t>(options.min_features)) {
    throw Error(
        ErrorCode::unusable_view,
        "only " + std::to_string(view.features.size()) + " features were found on the object and " +
            std::to_string(options.min_features) +
            " are needed; take a sharper picture from nearer, or of a side with more print");
  }
  return view;
}

}  // namespace posevote
