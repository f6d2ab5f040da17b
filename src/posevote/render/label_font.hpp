// Letters for labels: TrueType where there is a font, else OpenCV's plain ones.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace posevote {

class LabelFont {
 public:
  /// `height_px`: of a line of text.
  LabelFont(const std::string& font_file, int height_px);
  ~LabelFont();

  [[nodiscard]] int width_px(const std::string& text) const;
  /// Draws UTF-8 `text` with its base line's left end at `origin` into a BGR 8-bit picture.
  void draw(cv::Mat& image, const std::string& text, cv::Point origin,
            const cv::Scalar& color) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace posevote
