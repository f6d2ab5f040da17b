// A line to the test server that can be cut, or fall silent, at any moment.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <arpa/inet.h>

#include <array>
#include <atomic>
#include <list>
#include <string>
#include <thread>
#include <vector>

namespace posevote::postgres {

/// Passes on what comes in on a port of loopback to a Unix socket, and what comes back.
class Relay {
 public:
  explicit Relay(std::string socket_path)
      : socket_path_(std::move(socket_path)), listener_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    if (bind(listener_, reinterpret_cast<sockaddr*>(&place), size) != 0 ||
        listen(listener_, 16) != 0)
      throw std::runtime_error("the relay cannot listen");
    getsockname(listener_, reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~Relay() {
    stop_ = true;
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  [[nodiscard]] std::string address(const std::string& database) const {
    return "postgresql://tester@127.0.0.1:" + std::to_string(port_) + "/" + database +
           "?sslmode=disable";
  }

  /// Breaks all lines in the middle of the message after the next `messages`; new ones are served.
  void cut_after(int messages) { messages_left_ = messages; }
  /// Lets everything pass again; whether a cut came.
  bool end_cut() { return messages_left_.exchange(unlimited) == unlimited; }

  /// While it is down all lines are broken, and new ones as soon as they are there.
  void set_down(bool down) { down_ = down; }
  /// While it is frozen nothing passes, and nobody is told.
  void set_frozen(bool frozen) { frozen_ = frozen; }
  /// Bytes that the server has sent so far.
  [[nodiscard]] std::size_t received() const { return received_; }

 private:
  static constexpr int unlimited = -1;
  static constexpr std::chrono::milliseconds tick{10};
  struct Line {
    std::array<int, 2> ends;
  };

  void run() {
    while (!stop_) {
      while (down_ && !lines_.empty()) drop(lines_.begin());
      if (frozen_) {
        std::this_thread::sleep_for(tick);
        continue;
      }
      std::vector<pollfd> waiting{{listener_, POLLIN, 0}};
      for (const Line& line : lines_)
        for (const int end : line.ends) waiting.push_back({end, POLLIN, 0});
      poll(waiting.data(), waiting.size(), static_cast<int>(tick.count()));
      auto ready = waiting.begin() + 1;
      bool cut = false;
      for (auto line = lines_.begin(); line != lines_.end() && !cut;) {
        bool open = true;
        for (int from = 0; from < 2 && !cut; ++from, ++ready)
          if (open && ready->revents != 0) open = pass(*line, from, cut);
        line = open || cut ? std::next(line) : drop(line);
      }
      while (cut && !lines_.empty()) drop(lines_.begin());
      if (!stop_ && waiting.front().revents != 0) add_line();
    }
    while (!lines_.empty()) drop(lines_.begin());
  }

  /// Passes on what there is; false when the line has ended.
  bool pass(const Line& line, int from, bool& cut) {
    const ssize_t count = recv(line.ends[from], buffer_.data(), buffer_.size(), 0);
    if (count <= 0) return false;
    int left = messages_left_;
    while (left > 0 && !messages_left_.compare_exchange_weak(left, left - 1)) {
    }
    cut = left == 0 && messages_left_.compare_exchange_strong(left, unlimited);
    const ssize_t passed = cut ? count / 2 : count;
    if (from == 1) received_ += static_cast<std::size_t>(passed);
    return send(line.ends[1 - from], buffer_.data(), passed, MSG_NOSIGNAL) == passed;
  }

  void add_line() {
    const int client = accept(listener_, nullptr, nullptr);
    const int server = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    socket_path_.copy(place.sun_path, sizeof place.sun_path - 1);
    // A refused line ends as soon as something is to be passed on.
    static_cast<void>(connect(server, reinterpret_cast<sockaddr*>(&place), sizeof place));
    lines_.push_back({{client, server}});
  }

  std::list<Line>::iterator drop(std::list<Line>::iterator line) {
    for (const int end : line->ends) close(end);
    return lines_.erase(line);
  }

  std::string socket_path_;
  int listener_, port_ = 0;
  std::atomic<int> messages_left_ = unlimited;
  std::atomic<bool> stop_ = false, down_ = false, frozen_ = false;
  std::atomic<std::size_t> received_ = 0;
  std::list<Line> lines_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace posevote::postgres
