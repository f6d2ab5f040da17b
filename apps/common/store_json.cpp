#include "store_json.hpp"

#include <cmath>

namespace posevote {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json object_json(const ObjectSummary& object) {
  return {{"object", object.name},
          {"views", object.views},
          {"features", object.features},
          {"first_taught_at", object.first_taught_at},
          {"last_taught_at", object.last_taught_at}};
}

Json view_json(const ViewSummary& view) {
  return {{"view", view.id},
          {"yaw", number_or_null(view.yaw_deg)},
          {"width", view.image_size.width},
          {"height", view.image_size.height},
          {"features", view.features},
          {"coverage", view.coverage},
          {"method", view.method},
          {"source", view.provenance.source},
          {"taught_at", view.provenance.taught_at},
          {"version", view.provenance.version},
          {"hash", view.hash}};
}

}  // namespace posevote
