// Starts the real program `posevote serve` and talks to it.
#pragma once

#include <gmock/gmock.h>
#include <httplib.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace posevote {

using Json = nlohmann::ordered_json;

/// How long is waited for what must come: a machine that is busy with other things takes its time.
inline constexpr std::chrono::minutes kPatience{5};

/// Waits for `condition`, which is asked again and again; false when it does not come in time.
inline bool eventually(const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A running server; killed when it goes. Its output goes to files in `folder`.
class ServerProcess {
 public:
  /// `arguments` follow `posevote serve`; without --db with FOLDER/objects.db, without --listen on
  /// any free port.
  ServerProcess(const std::string& folder, const std::vector<std::string>& arguments,
                const std::map<std::string, std::string>& environment = {});
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  [[nodiscard]] const std::string& address() const { return address_; }  ///< without the last /
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int pid() const { return pid_; }
  /// Trusts the certificate given by --tls-cert.
  [[nodiscard]] httplib::Client client() const;
  void send_signal(int signal) const;
  /// The exit status, or minus the signal that ended it.
  int wait();

 private:
  int pid_ = -1;
  int port_ = 0;
  std::string address_, certificate_;
};

/// A test with a folder of its own.
class ServerTest : public testing::Test {
 protected:
  ServerTest();
  ~ServerTest() override;

  void start(const std::vector<std::string>& arguments = {},
             const std::map<std::string, std::string>& environment = {});
  [[nodiscard]] httplib::Client client() const { return server_->client(); }
  /// A connection to the server, for bytes as they are; to be closed.
  [[nodiscard]] int open_socket() const;

  /// Requests that must succeed; the body as JSON.
  Json get(const std::string& path);
  Json post(const std::string& path, const std::string& body = "",
            const std::string& type = "image/jpeg");
  Json patch(const std::string& path, const Json& body);
  /// Teaches a cover picture of the demo set.
  void teach_poster();

  /// A folder with copies of these files, for --camera.
  std::string make_camera(const std::string& name, const std::vector<std::string>& pictures);
  static std::string demo(const std::string& path);
  static std::string content(const std::string& path);

  std::string folder_;
  std::unique_ptr<ServerProcess> server_;
};

}  // namespace posevote
