#include "server_process.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "posevote/core/arguments.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Json parse(const httplib::Result& result, const std::string& what) {
  if (!result) throw std::runtime_error(what + ": " + httplib::to_string(result.error()));
  if (result->status >= 300)
    throw std::runtime_error(what + ": " + std::to_string(result->status) + " " + result->body);
  return result->body.empty() ? Json() : Json::parse(result->body);
}

}  // namespace

ServerProcess::ServerProcess(const std::string& folder, const std::vector<std::string>& arguments,
                             const std::map<std::string, std::string>& environment) {
  std::vector<std::string> words{POSEVOTE_PROGRAM, "serve"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::pair<std::string, std::string> defaults[]{{"--db", folder + "/objects.db"},
                                                       {"--listen", "127.0.0.1:0"}};
  for (const auto& [option, value] : defaults)
    if (std::ranges::find(arguments, option) == arguments.end())
      words.insert(words.end(), {option, value});
  const auto tls = std::ranges::find(arguments, "--tls-cert");
  if (tls != arguments.end() && tls + 1 != arguments.end()) certificate_ = tls[1];
  const std::vector<char*> argv = argv_of(words);
  const std::string out = folder + "/out.txt", err = folder + "/err.txt";
  fs::remove(out);
  pid_ = fork();
  if (pid_ == 0) {
    const int mode = O_WRONLY | O_CREAT | O_TRUNC;
    dup2(open(out.c_str(), mode, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), mode, 0600), STDERR_FILENO);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(argv[0], argv.data());
    _exit(127);
  }
  const bool begun = eventually([&] {
    const std::string said = read_all(out);
    const std::size_t host = said.find("://127.0.0.1:"), end = said.find("/ serves");
    if (host != std::string::npos && end != std::string::npos) {
      address_ = said.substr(0, end);
      port_ = std::stoi(address_.substr(address_.rfind(':') + 1));
    }
    return port_ != 0 || waitpid(pid_, nullptr, WNOHANG) != 0;
  });
  if (!begun || port_ == 0) throw std::runtime_error("the server does not begin: " + read_all(err));
}

ServerProcess::~ServerProcess() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

httplib::Client ServerProcess::client() const {
  httplib::Client client(address_);
  if (!certificate_.empty()) client.set_ca_cert_path(certificate_);
  client.set_read_timeout(kPatience);
  client.set_connection_timeout(kPatience);
  client.set_keep_alive(true);
  return client;
}

void ServerProcess::send_signal(int signal) const {
  kill(pid_, signal);
}

int ServerProcess::wait() {
  int status = 0;
  const bool ended = eventually([&] { return waitpid(pid_, &status, WNOHANG) == pid_; });
  if (!ended) throw std::runtime_error("the server does not end");
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

ServerTest::ServerTest() {
  std::string pattern = (fs::temp_directory_path() / "posevote-server-XXXXXX").string();
  folder_ = mkdtemp(pattern.data());
}

ServerTest::~ServerTest() {
  server_.reset();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void ServerTest::start(const std::vector<std::string>& arguments,
                       const std::map<std::string, std::string>& environment) {
  server_.reset();
  server_ = std::make_unique<ServerProcess>(folder_, arguments, environment);
}

int ServerTest::open_socket() const {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server_->port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return socket;
}

Json ServerTest::get(const std::string& path) {
  return parse(client().Get(path), "GET " + path);
}

Json ServerTest::post(const std::string& path, const std::string& body, const std::string& type) {
  return parse(client().Post(path, body, type), "POST " + path);
}

Json ServerTest::patch(const std::string& path, const Json& body) {
  return parse(client().Patch(path, body.dump(), "application/json"), "PATCH " + path);
}

void ServerTest::teach_poster() {
  post("/api/objects/poster/views", content(demo("train/poster/cover.jpg")));
}

std::string ServerTest::make_camera(const std::string& name,
                                    const std::vector<std::string>& pictures) {
  std::string camera = folder_ + "/" + name;
  fs::create_directory(camera);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    fs::copy_file(pictures[i], camera + "/" + std::to_string(100 + i) + ".jpg");
  return camera;
}

std::string ServerTest::demo(const std::string& path) {
  return std::string(POSEVOTE_SOURCE_DIR) + "/data/demo/" + path;
}

std::string ServerTest::content(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error("there is no file " + path);
  return read_all(path);
}

}  // namespace posevote
