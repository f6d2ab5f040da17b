// The services that both ROSes offer, on requests and responses of either's types.
#pragma once

#include <exception>

#include "logic/fill_message.hpp"

namespace posevote::logic {

/// Runs `act(request, response)`; what cannot be done is a response that says why.
template <class Request, class Response, class Act>
void serve(const Request& request, Response& response, const Act& act) {
  try {
    act(request, response);
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
}

template <class Request, class Response>
void list_objects(ObjectRecognition& recognition, const Request&, Response& response) {
  fill_database(response.database, recognition.database());
}

template <class Request, class Response>
void remove_object(ObjectRecognition& recognition, const Request& request, Response&) {
  recognition.remove(request.object, request.view);
}

template <class Request, class Response>
void rename_object(ObjectRecognition& recognition, const Request& request, Response&) {
  recognition.rename(request.object, request.new_name);
}

template <class Request, class Response>
void set_active_objects(ObjectRecognition& recognition, const Request& request, Response&) {
  recognition.set_active(request.objects);
}

template <class Request, class Response>
void save_database(ObjectRecognition& recognition, const Request& request, Response& response) {
  response.path = recognition.save(request.path);
}

template <class Request, class Response>
void export_objects(ObjectRecognition& recognition, const Request& request, Response& response) {
  const TransferResult result =
      recognition.export_to(request.path, request.objects, request.overwrite);
  response.objects_written = static_cast<std::uint32_t>(result.objects);
  response.views_written = static_cast<std::uint32_t>(result.views_added);
}

template <class Request, class Response>
void import_objects(ObjectRecognition& recognition, const Request& request, Response& response) {
  const TransferResult result =
      recognition.import_from(request.path, request.objects, request.on_conflict);
  response.objects_read = static_cast<std::uint32_t>(result.objects);
  response.views_added = static_cast<std::uint32_t>(result.views_added);
  response.views_known = static_cast<std::uint32_t>(result.views_known);
}

/// Detect, once there is a picture. `header`: the picture's.
template <class Response, class Header>
void detect_in(ObjectRecognition& recognition, const cv::Mat& picture,
               const std::optional<Camera>& camera, const Header& header, bool draw,
               Response& response) {
  const Findings findings = recognition.recognize_once(picture, camera);
  response.result.header = header;
  fill_detections(response.result, findings, 0);
  response.message = findings.problem;
  if (!draw) return;
  response.annotated.header = header;
  fill_image(response.annotated, annotate(picture, findings.result));
}

}  // namespace posevote::logic
