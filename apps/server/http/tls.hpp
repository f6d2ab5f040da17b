// HTTPS: the server's certificate, and the encryption of one connection.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

struct ssl_ctx_st;
struct ssl_st;

namespace posevote::server {

/// A certificate with its private key, for TLS 1.2 and newer. Safe for many threads.
class Certificate {
 public:
  /// PEM files: the certificate, followed by those that vouch for it, and its key without a
  /// passphrase. Throws Error{io} when one cannot be read, Error{invalid_argument} when they do not
  /// belong together.
  Certificate(const std::string& certificate_file, const std::string& key_file);

  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }

 private:
  struct Free {
    void operator()(ssl_ctx_st* context) const;
  };
  std::unique_ptr<ssl_ctx_st, Free> context_;
};

/// The server's end of one connection. Never waits; the handshake is part of receiving. SIGPIPE
/// must be ignored, as the HTTP library does.
class Tls {
 public:
  /// `socket` is set to never block and must outlive this.
  Tls(const Certificate& certificate, int socket);
  ~Tls();  ///< tells the client that nothing more comes
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;

  /// Like recv and send: bytes, 0 at the end, -1 for an error. EAGAIN: call again with the same
  /// bytes when the socket is ready for `wanted`.
  ssize_t receive(char* data, std::size_t size);
  ssize_t send(const char* data, std::size_t size);

  [[nodiscard]] short wanted() const { return wanted_; }  ///< POLLIN or POLLOUT
  /// The client speaks HTTP without TLS.
  [[nodiscard]] bool met_plain_http() const { return met_plain_http_; }

 private:
  ssize_t failure(int result);

  struct Free {
    void operator()(ssl_st* connection) const;
  };
  std::unique_ptr<ssl_st, Free> ssl_;
  short wanted_;
  bool met_plain_http_ = false;
};

}  // namespace posevote::server
