// posevote_msgs on the wire: bytes that Jazzy's rmw_cyclonedds made of a message are read by plain
// Cyclone DDS, with types made of the package's .idl files, and written again.
//
// In detections.cdr the fields have the values that are expected here, each another one.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "posevote_msgs/msg/DetectionArray.h"

namespace {

using Message = posevote_msgs_msg_DetectionArray;

int failures = 0;

void expect(bool condition, const char* what) {
  if (condition) return;
  ++failures;
  std::fprintf(stderr, "not as it was sent: %s\n", what);
}

#define EXPECT(condition) expect(condition, #condition)

dds_return_t checked(dds_return_t code) {
  if (code < 0) throw std::runtime_error(dds_strretcode(code));
  return code;
}

/// A reader and a writer that meet each other.
struct Endpoints {
  dds_entity_t participant = checked(dds_create_participant(DDS_DOMAIN_DEFAULT, nullptr, nullptr));
  dds_entity_t topic = checked(dds_create_topic(participant, &posevote_msgs_msg_DetectionArray_desc,
                                                "detections", nullptr, nullptr));
  dds_entity_t reader = checked(dds_create_reader(participant, topic, nullptr, nullptr));
  dds_entity_t writer = checked(dds_create_writer(participant, topic, nullptr, nullptr));

  /// The message as it is sent: four bytes that name the encoding, then CDR.
  [[nodiscard]] ddsi_serdata* send(const Message& message) const {
    checked(dds_write(writer, &message));
    ddsi_serdata* sent = nullptr;
    dds_sample_info_t info;
    if (checked(dds_takecdr(reader, &sent, 1, &info, DDS_ANY_STATE)) != 1)
      throw std::runtime_error("what was written was not read");
    return sent;
  }
};

std::string bytes_of(const ddsi_serdata* sent) {
  std::string bytes(ddsi_serdata_size(sent), '\0');
  ddsi_serdata_to_ser(sent, 0, bytes.size(), bytes.data());
  return bytes;
}

void check_pose(const geometry_msgs_msg_Pose& pose, double first) {
  EXPECT(pose.position.x == first && pose.position.y == first + 1);
  EXPECT(pose.position.z == first + 2);
  EXPECT(pose.orientation.x == first + 3 && pose.orientation.y == first + 4);
  EXPECT(pose.orientation.z == first + 5 && pose.orientation.w == first + 6);
}

void check_detection(const posevote_msgs_msg_Detection& found) {
  EXPECT(std::string(found.object) == "mug" && std::string(found.view) == "view");
  EXPECT(found.alternatives._length == 2 && std::string(found.alternatives._buffer[1]) == "jug");
  EXPECT(found.confidence == 0.125F && found.probability == 0.25F);
  EXPECT(found.log10_false_alarms == -8.5F);
  EXPECT(found.inliers == 9 && found.features_in_area == 10);
  for (int i = 0; i < 9; ++i) EXPECT(found.homography[i] == 11 + i);
  EXPECT(found.outline._length == 3 && found.outline._buffer[2].x == 24);
  EXPECT(found.outline._length == 3 && found.outline._buffer[2].y == 25);
  EXPECT(found.box.x == 26 && found.box.y == 27);
  EXPECT(found.box.width == 28 && found.box.height == 29);
  EXPECT(found.track == 30 && found.confirmed && std::string(found.frame) == "posevote/mug_1");
  EXPECT(found.has_pose && !found.pose_ambiguous && found.pose_flat);
  check_pose(found.pose, 31);
  check_pose(found.other_pose, 38);
  EXPECT(found.pose_error_px == 45.5F);
}

void check_message(const Message& message) {
  EXPECT(message.header.stamp.sec == 1 && message.header.stamp.nanosec == 2);
  EXPECT(std::string(message.header.frame_id) == "camera");
  EXPECT(message.image_width == 3 && message.image_height == 4);
  EXPECT(message.detections._length == 1);
  if (message.detections._length == 1) check_detection(message.detections._buffer[0]);
  EXPECT(message.time_ms == 5.5F && message.features == 6 && message.dropped == 7);
}

void check(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string recorded{std::istreambuf_iterator<char>(file), {}};
  const Endpoints own;
  const ddsi_sertype* type = own.send({})->type;
  const ddsrt_iovec_t part{recorded.data(), recorded.size()};
  const ddsi_serdata* received =
      ddsi_serdata_from_ser_iov(type, SDK_DATA, 1, &part, recorded.size());
  Message message{};
  if (!received || !ddsi_serdata_to_sample(received, &message, nullptr, nullptr))
    throw std::runtime_error("'" + path + "' is no DetectionArray");
  check_message(message);
  expect(bytes_of(own.send(message)) == recorded, "its bytes, when it is written again");
}

}  // namespace

int main(int, char** argv) try {
  check(argv[1]);
  return failures == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "wire: %s\n", error.what());
  return 1;
}
