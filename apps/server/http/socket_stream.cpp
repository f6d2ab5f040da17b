#include "http/socket_stream.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

namespace posevote::server {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMaxHead = 32'768;

std::chrono::steady_clock::duration seconds(double value) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(value));
}

void address_of(const sockaddr_storage& address, std::string& ip, int& port) {
  char text[INET6_ADDRSTRLEN] = "";
  if (address.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    inet_ntop(AF_INET, &v4.sin_addr, text, sizeof text);
    port = ntohs(v4.sin_port);
  } else if (address.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
    inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof text);
    port = ntohs(v6.sin6_port);
  }
  ip = text;
}

}  // namespace

SocketStream::SocketStream(int socket, const Limits& limits, const std::atomic<bool>& stopping,
                           const Certificate* certificate)
    : socket_(socket), limits_(limits), stopping_(stopping) {
  const int on = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (certificate) tls_.emplace(*certificate, socket_);
}

SocketStream::~SocketStream() {
  tls_.reset();
  shutdown(socket_, SHUT_RDWR);
  close(socket_);
}

SocketStream::Ready SocketStream::wait(short events, Clock::time_point until) const {
  pollfd poll_of{socket_, events, 0};
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(until - Clock::now()).count();
    const int got = poll(&poll_of, 1, static_cast<int>(std::clamp<long long>(left, 0, 60000)));
    if (got > 0) return (poll_of.revents & events) != 0 ? Ready::yes : Ready::gone;
    if (got < 0 && errno != EINTR) return Ready::gone;
    if (left <= 0) return Ready::no;
  }
}

bool SocketStream::wait_for_request() {
  const auto until = Clock::now() + seconds(limits_.idle_s);
  while (begin_ == end_) {
    if (stopping_ || Clock::now() > until) return false;
    Ready ready = fill();
    if (ready == Ready::no)
      ready = wait(wanted(), std::min(until, Clock::now() + milliseconds(100)));
    if (ready == Ready::gone) return false;
  }
  deadline_ = Clock::now() + seconds(limits_.request_s);
  head_left_ = kMaxHead;
  in_head_ = true;
  timed_out_ = false;
  return true;
}

void SocketStream::begin_body() {
  deadline_ = Clock::now() + seconds(limits_.request_s);
  in_head_ = false;
}

short SocketStream::wanted() const {
  return tls_ ? tls_->wanted() : POLLIN;
}

/// Tried before any waiting: TLS may have received bytes that the socket does not show any more.
SocketStream::Ready SocketStream::fill() {
  const ssize_t got = tls_ ? tls_->receive(buffer_, sizeof buffer_)
                           : recv(socket_, buffer_, sizeof buffer_, MSG_DONTWAIT);
  if (got < 0 && errno == EAGAIN) return Ready::no;
  if (got <= 0) return Ready::gone;
  begin_ = 0;
  end_ = static_cast<std::size_t>(got);
  if (!in_head_) deadline_ += seconds(static_cast<double>(got) / (256 * 1024));
  return Ready::yes;
}

ssize_t SocketStream::read(char* data, size_t size) {
  for (;;) {
    Ready ready = begin_ == end_ ? fill() : Ready::yes;
    // Bytes that come slowly but steadily must not keep a request alive either.
    timed_out_ = Clock::now() > deadline_;
    if (timed_out_ || ready == Ready::gone) return -1;
    if (ready == Ready::yes) break;
    if (wait(wanted(), deadline_) == Ready::gone) return -1;
  }
  const std::size_t taken = std::min(size, end_ - begin_);
  if (in_head_) {
    if (taken > head_left_) return -1;
    head_left_ -= taken;
  }
  std::copy_n(buffer_ + begin_, taken, data);
  begin_ += taken;
  return static_cast<ssize_t>(taken);
}

ssize_t SocketStream::write(const char* data, size_t size) {
  if (size == 0) return 0;
  while (is_writable()) {
    const ssize_t sent =
        tls_ ? tls_->send(data, size) : send(socket_, data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0 || errno != EAGAIN) return sent;
  }
  return -1;
}

bool SocketStream::peer_gone() const {
  pollfd poll_of{socket_, POLLRDHUP, 0};
  return poll(&poll_of, 1, 0) != 0;
}

void SocketStream::linger() {
  tls_.reset();
  shutdown(socket_, SHUT_WR);
  const auto until = Clock::now() + std::chrono::seconds(2);
  while (Clock::now() < until && wait(POLLIN, until) == Ready::yes)
    if (recv(socket_, buffer_, sizeof buffer_, MSG_DONTWAIT) <= 0) return;
}

void SocketStream::prefer_fresh() {
  const int bytes = 64 * 1024;
  setsockopt(socket_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &bytes, sizeof bytes);
}

bool SocketStream::is_readable() const {
  return begin_ < end_ || wait(POLLIN, deadline_) == Ready::yes;
}

bool SocketStream::is_writable() const {
  return wait(POLLOUT, Clock::now() + seconds(limits_.wait_s)) == Ready::yes;
}

void SocketStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getpeername(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    address_of(address, ip, port);
}

void SocketStream::get_local_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    address_of(address, ip, port);
}

}  // namespace posevote::server
