// What can be set about the live picture.
#pragma once

#include "posevote/core/options.hpp"

namespace posevote::server {

struct LiveOptions {
  bool recognize = true;    ///< look for objects in the camera's frames
  double max_fps = 30;      ///< recognise at most so many frames a second
  int stream_width = 960;   ///< px; wider frames are reduced before they are streamed
  int stream_quality = 75;  ///< JPEG quality of streamed frames
  void describe(OptionList& list);
};

}  // namespace posevote::server
