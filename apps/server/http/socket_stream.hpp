// A connection's bytes with limits on time and size: what the HTTP library reads from and writes
// to.
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <optional>

#include "http/limits.hpp"
#include "http/tls.hpp"

namespace posevote::server {

/// Used by the connection's own thread only. A request has three phases: waiting for its first
/// byte (and for the handshake of TLS), its head (32 KB at most), its body. Reads fail when a phase
/// takes longer than `Limits` allow; writes fail when the client takes nothing for `wait_s`.
class SocketStream : public httplib::Stream {
 public:
  /// Closes `socket` in the end. `certificate`: null for plain HTTP.
  SocketStream(int socket, const Limits& limits, const std::atomic<bool>& stopping,
               const Certificate* certificate);
  ~SocketStream() override;
  SocketStream(const SocketStream&) = delete;
  SocketStream& operator=(const SocketStream&) = delete;

  /// Waits for the first byte of the next request and begins its head. False: the client has left
  /// or is silent, or the server is being stopped.
  [[nodiscard]] bool wait_for_request();
  void begin_body();
  [[nodiscard]] bool timed_out() const { return timed_out_; }
  /// Lets the client read what was written before the connection is closed, although it may still
  /// be sending: a close with unread bytes would destroy the response on its way.
  void linger();
  /// Pictures are worth nothing when they are late: keeps the kernel from queueing many.
  void prefer_fresh();
  /// The client has closed its side.
  [[nodiscard]] bool peer_gone() const;
  /// The client speaks HTTP where HTTPS is needed.
  [[nodiscard]] bool met_plain_http() const { return tls_ && tls_->met_plain_http(); }

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* data, size_t size) override;
  ssize_t write(const char* data, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;

  enum class Ready { yes, no, gone };
  Ready wait(short events, Clock::time_point until) const;
  Ready fill();
  [[nodiscard]] short wanted() const;

  int socket_;
  const Limits& limits_;
  const std::atomic<bool>& stopping_;
  std::optional<Tls> tls_;
  Clock::time_point deadline_;
  std::size_t head_left_ = 0;  ///< bytes that the head may still have
  bool in_head_ = true;
  bool timed_out_ = false;
  char buffer_[16384];
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace posevote::server
