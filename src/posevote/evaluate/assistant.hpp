// Makes a dataset.json from folders of pictures, adds to it, and finds its mistakes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posevote/evaluate/dataset.hpp"

namespace posevote {

/// A mistake or something to think about, with its place, e.g. "tests[3].objects[0].box".
struct DatasetProblem {
  bool is_error = true;  ///< false: a hint, the dataset works
  std::string where;
  std::string what;
};

/// Opens every picture. Errors: pictures that are missing or damaged, background, mask or
/// truth_mask of another size than the view, boxes that lie outside or cover nothing, names in
/// tests that are never taught, objects without views. Hints: objects never asked for, twins that
/// name no object, a test picture that is listed twice or is also taught, JPEG pictures with an
/// Exif orientation (it is not applied), fields that are not known.
[[nodiscard]] std::vector<DatasetProblem> check_dataset(const std::filesystem::path& path);

/// The text of a dataset.json for what lies in `folder`:
///   train/NAME/PICTURE      views of object NAME. Beside them: background.EXT is the background of
///                           all; PICTURE-mask.EXT or PICTURE_mask.EXT is a mask; a number after
///                           "y" or "yaw" at the end of PICTURE is its turn ("y030",
///                           "front_yaw-45")
///   test/GROUP/PICTURE      tests of that group; test/PICTURE: without a group
/// Boxes are to be added: `add_to_dataset`. Deterministic: names in alphabetical order.
/// Throws Error{not_found} when there is neither train nor test.
[[nodiscard]] std::string make_dataset(const std::filesystem::path& folder);

/// What to add: a test picture, or objects in it. All paths relative to the dataset's folder.
struct DatasetAddition {
  std::string image;
  std::string group;                 ///< "": unchanged, or none for a new test
  std::vector<TruthObject> objects;  ///< appended to those listed
};

/// The text of the dataset.json with the addition; a picture that is a test already gets more
/// objects. Everything else in the file stays, fields that are not known too. Throws as
/// `load_dataset` does.
[[nodiscard]] std::string add_to_dataset(const std::filesystem::path& path,
                                         const DatasetAddition& addition);

/// Reads "NAME=X,Y,W,H". Throws Error{invalid_argument}.
[[nodiscard]] TruthObject parse_truth(const std::string& text);

/// dataset.json in `path` when that is a folder, else `path`.
[[nodiscard]] std::filesystem::path dataset_file(const std::filesystem::path& path);

/// Writes a file as a whole or not at all. Throws Error{io}.
void replace_file(const std::filesystem::path& file, const std::string& text);

}  // namespace posevote
