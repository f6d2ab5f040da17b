// How much one client, and all of them together, may ask for.
#pragma once

#include "posevote/core/options.hpp"

namespace posevote::server {

struct Limits {
  int connections = 96;          ///< at once; more are turned away with 503
  int streams = 32;              ///< clients that watch frames or events at once
  int sessions = 8;              ///< teach sessions at once
  int jobs = 2;                  ///< recognitions and lessons computed at once for requests
  double body_mb = 20;           ///< one request
  double import_mb = 256;        ///< one imported file
  double bodies_mb = 300;        ///< all request bodies in memory together
  double megapixels = 25;        ///< one picture, before it is decoded
  double request_s = 20;         ///< for a request to arrive, plus a second per 256 KB
  double wait_s = 10;            ///< for a free place among the jobs, and for a client that reads
  double idle_s = 30;            ///< before a silent connection is closed
  double session_idle_s = 3600;  ///< before a teach session that nobody touches is discarded
  double undo_s = 3600;          ///< during which a deletion can be undone
  void describe(OptionList& list);
};

}  // namespace posevote::server
