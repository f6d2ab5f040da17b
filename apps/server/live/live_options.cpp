#include "live/live_options.hpp"

namespace posevote::server {

void LiveOptions::describe(OptionList& list) {
  list.add("recognize", recognize, "Look for objects in the camera's pictures.");
  list.add(
      "max_fps", max_fps, {0.1, 1000}, "fps",
      "Pictures a second that are searched at most; fewer leave more of the processor to others.");
  list.add("stream_width", stream_width, {64, 8192}, "px",
           "Wider pictures are reduced to this width before they are shown.");
  list.add("stream_quality", stream_quality, {10, 100}, "",
           "JPEG quality of the pictures that are shown; less needs less of the network.");
}

}  // namespace posevote::server
