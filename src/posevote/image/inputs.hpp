// What people name on a command line: pictures, folders of pictures, video files, cameras.
#pragma once

#include <string>
#include <vector>

namespace posevote {

enum class InputKind { image, video, camera };

struct Input {
  InputKind kind = InputKind::image;
  std::string path;  ///< as given; pictures of a folder as folder/name
  int camera = -1;   ///< N of "camera:N"
};

/// What `argument` stands for: "camera:N" the N-th camera; a folder the pictures in it (by file
/// name ending, sorted by name, without sub-folders); a name with a video's ending one video;
/// anything else one picture, whether it exists or not. Throws Error{not_found} for a folder
/// without pictures, Error{unreadable_image} for one that cannot be opened, Error{invalid_argument}
/// for "camera:x".
[[nodiscard]] std::vector<Input> expand_input(const std::string& argument);

}  // namespace posevote
