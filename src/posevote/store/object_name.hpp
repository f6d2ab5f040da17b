// Which names objects may have.
#pragma once

#include <string>

namespace posevote {

/// Any UTF-8 text of 1 to 200 bytes without control characters (also line breaks) that neither
/// begins nor ends with a space. Throws Error{invalid_argument} with the reason.
void check_object_name(const std::string& name);

}  // namespace posevote
