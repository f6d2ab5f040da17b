#include "http/tls.hpp"

#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>

#include <cstring>
#include <new>

#include "posevote/core/error.hpp"

namespace posevote::server {
namespace {

/// OpenSSL's reason for its first failure.
std::string reason() {
  const unsigned long error = ERR_peek_error();
  const char* text = ERR_SYSTEM_ERROR(error) ? std::strerror(ERR_GET_REASON(error))
                                             : ERR_reason_error_string(error);
  return text ? text : "unknown reason";
}

int no_passphrase(char*, int, int, void*) {
  return -1;  // OpenSSL would ask on the terminal
}

}  // namespace

void Certificate::Free::operator()(SSL_CTX* context) const {
  SSL_CTX_free(context);
}

Certificate::Certificate(const std::string& certificate_file, const std::string& key_file) {
  ERR_clear_error();
  context_.reset(SSL_CTX_new(TLS_server_method()));
  SSL_CTX* context = context_.get();
  if (!context || SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) != 1)
    throw Error(ErrorCode::io, "this system's OpenSSL cannot serve TLS 1.2: " + reason());
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION);
  SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_default_passwd_cb(context, no_passphrase);
  if (SSL_CTX_use_PrivateKey_file(context, key_file.c_str(), SSL_FILETYPE_PEM) != 1)
    throw Error(ErrorCode::io, "cannot read a private key, in PEM without a passphrase, from '" +
                                   key_file + "': " + reason());
  if (SSL_CTX_use_certificate_chain_file(context, certificate_file.c_str()) != 1)
    throw Error(ErrorCode::io,
                "cannot use '" + certificate_file + "' as a certificate in PEM: " + reason());
  if (SSL_CTX_check_private_key(context) != 1)
    throw Error(ErrorCode::invalid_argument, "the private key in '" + key_file +
                                                 "' does not belong to the certificate in '" +
                                                 certificate_file + "'");
}

void Tls::Free::operator()(SSL* connection) const {
  SSL_free(connection);
}

Tls::Tls(const Certificate& certificate, int socket)
    : ssl_(SSL_new(certificate.context())), wanted_(POLLIN) {
  if (!ssl_ || SSL_set_fd(ssl_.get(), socket) != 1) throw std::bad_alloc();
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
  SSL_set_accept_state(ssl_.get());
}

Tls::~Tls() {
  ERR_clear_error();
  if (SSL_is_init_finished(ssl_.get())) SSL_shutdown(ssl_.get());
}

ssize_t Tls::receive(char* data, std::size_t size) {
  ERR_clear_error();
  std::size_t got = 0;
  const int result = SSL_read_ex(ssl_.get(), data, size, &got);
  return result == 1 ? static_cast<ssize_t>(got) : failure(result);
}

ssize_t Tls::send(const char* data, std::size_t size) {
  ERR_clear_error();
  std::size_t sent = 0;
  const int result = SSL_write_ex(ssl_.get(), data, size, &sent);
  return result == 1 ? static_cast<ssize_t>(sent) : failure(result);
}

ssize_t Tls::failure(int result) {
  const int error = SSL_get_error(ssl_.get(), result);
  if (error == SSL_ERROR_ZERO_RETURN) return 0;
  if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE) {
    wanted_ = error == SSL_ERROR_WANT_READ ? POLLIN : POLLOUT;
    errno = EAGAIN;
  } else {
    met_plain_http_ = ERR_GET_REASON(ERR_peek_error()) == SSL_R_HTTP_REQUEST;
    errno = EPROTO;
  }
  return -1;
}

}  // namespace posevote::server
