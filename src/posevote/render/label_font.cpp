#include "posevote/render/label_font.hpp"

#include <filesystem>
#include <opencv2/imgproc.hpp>
#ifdef POSEVOTE_WITH_FREETYPE
#include <opencv2/freetype.hpp>
#endif

namespace posevote {
namespace {

constexpr int plain_font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double plain_letter_px = 22;  // height of its capitals at scale 1

/// One '?' for every letter that the plain font lacks.
std::string to_ascii(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) plain += c;
    if (byte >= 0xc0) plain += '?';
  }
  return plain;
}

}  // namespace

struct LabelFont::State {
  int height_px = 0;
#ifdef POSEVOTE_WITH_FREETYPE
  cv::Ptr<cv::freetype::FreeType2> font;
#endif
  [[nodiscard]] double plain_scale() const {
    return 0.7 * height_px / plain_letter_px;
  }
  [[nodiscard]] int plain_thickness() const {
    return std::max(1, height_px / 14);
  }
};

LabelFont::LabelFont(const std::string& font_file, int height_px)
    : state_(std::make_unique<State>()) {
  state_->height_px = height_px;
#ifdef POSEVOTE_WITH_FREETYPE
  if (!std::filesystem::is_regular_file(font_file)) return;
  try {
    const auto font = cv::freetype::createFreeType2();
    font->loadFontData(font_file, 0);
    state_->font = font;
  } catch (const cv::Exception&) {
    // Not a font: the plain letters do.
  }
#else
  static_cast<void>(font_file);
#endif
}

LabelFont::~LabelFont() = default;

int LabelFont::width_px(const std::string& text) const {
  int base_line = 0;
#ifdef POSEVOTE_WITH_FREETYPE
  if (state_->font) return state_->font->getTextSize(text, state_->height_px, -1, &base_line).width;
#endif
  return cv::getTextSize(to_ascii(text), plain_font, state_->plain_scale(),
                         state_->plain_thickness(), &base_line)
      .width;
}

void LabelFont::draw(cv::Mat& image, const std::string& text, cv::Point origin,
                     const cv::Scalar& color) const {
#ifdef POSEVOTE_WITH_FREETYPE
  if (state_->font) {
    state_->font->putText(image, text, origin, state_->height_px, color, -1, cv::LINE_AA, true);
    return;
  }
#endif
  cv::putText(image, to_ascii(text), origin, plain_font, state_->plain_scale(), color,
              state_->plain_thickness(), cv::LINE_AA);
}

}  // namespace posevote
