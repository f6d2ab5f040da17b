#include "http/access.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <algorithm>
#include <chrono>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

constexpr const char* kCookie = "posevote=";

std::string hex(const unsigned char* data, std::size_t size) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    text += digits[data[i] >> 4];
    text += digits[data[i] & 15];
  }
  return text;
}

std::string keyed_hash(const std::string& key, const std::string& text) {
  unsigned char hash[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
       reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash, &size);
  return hex(hash, size);
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// "[::1]:8080" -> "::1"
std::string without_port(const std::string& authority) {
  if (authority.starts_with('[')) return authority.substr(1, authority.find(']') - 1);
  return authority.substr(0, authority.find(':'));
}

std::string cookie_of(const Request& request) {
  const std::string all = request.header("Cookie");
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find(';', at), all.size());
    const std::string one = all.substr(at, end - at);
    if (one.starts_with(kCookie)) return one.substr(std::string(kCookie).size());
    at = std::min(all.find_first_not_of("; ", end), all.size());
  }
  return "";
}

double now_s() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace

bool equal_in_constant_time(const std::string& a, const std::string& b) {
  const std::string key = random_hex(16);  // hashes have one length whatever is compared
  const std::string left = keyed_hash(key, a), right = keyed_hash(key, b);
  return CRYPTO_memcmp(left.data(), right.data(), left.size()) == 0;
}

bool is_loopback(const std::string& host) {
  const std::string name = lower(host);
  return name == "localhost" || name == "::1" || name.ends_with(".localhost") ||
         (name.starts_with("127.") && name.find_first_not_of("0123456789.") == std::string::npos);
}

std::string random_hex(int bytes) {
  std::vector<unsigned char> data(static_cast<std::size_t>(bytes));
  if (RAND_bytes(data.data(), bytes) != 1)
    throw Error(ErrorCode::io, "this system gives no random numbers");
  return hex(data.data(), data.size());
}

AccessControl::AccessControl(AccessOptions options)
    : options_(std::move(options)), cookie_(keyed_hash(options_.token, "posevote page")) {
  for (std::string& host : options_.hosts) host = lower(host);
}

void AccessControl::check_origin(const Request& request) const {
  const auto forbid = [](const std::string& sentence) -> Problem {
    return {403, "forbidden", sentence};
  };
  const std::string host = lower(request.header("Host"));
  const std::string name = without_port(host);
  if (!options_.any_host && !is_loopback(name) &&
      std::ranges::find(options_.hosts, name) == options_.hosts.end())
    throw forbid("this server is not called '" + name + "'; see posevote serve --help, --host");
  if (request.method == "GET") return;
  const std::string origin = lower(request.header("Origin"));
  const std::string site = lower(request.header("Sec-Fetch-Site"));
  const bool same = origin == "https://" + host || (!options_.https && origin == "http://" + host);
  if ((!origin.empty() && !same) || (!site.empty() && site != "same-origin" && site != "none"))
    throw forbid("the request comes from another site");
}

bool AccessControl::authenticated(const Request& request) const {
  if (!token_needed()) return true;
  const std::string header = request.header("Authorization"), cookie = cookie_of(request);
  if (header.size() > 7 && lower(header.substr(0, 7)) == "bearer ")
    return equal_in_constant_time(header.substr(7), options_.token);
  return !cookie.empty() && equal_in_constant_time(cookie, cookie_);
}

void AccessControl::check_token(const Request& request) const {
  if (!authenticated(request)) throw Problem(401, "unauthorized", "the token is missing or wrong");
}

void AccessControl::count_failure() {
  const std::lock_guard lock(mutex_);
  failures_.push_back(now_s());
}

std::string AccessControl::login(const std::string& token) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(failures_, [now = now_s()](double when) { return when < now - 60; });
    if (failures_.size() >= 10) throw too_many("there were too many wrong tokens; wait a minute");
  }
  if (token_needed() && !equal_in_constant_time(token, options_.token)) {
    count_failure();
    throw Problem(401, "unauthorized", "this is not the token");
  }
  return set_cookie(cookie_, 30 * 24 * 3600);
}

std::string AccessControl::logout() const {
  return set_cookie("", 0);
}

std::string AccessControl::set_cookie(const std::string& value, int seconds) const {
  return kCookie + value + "; Path=/; Max-Age=" + std::to_string(seconds) +
         "; HttpOnly; SameSite=Strict" + (options_.https ? "; Secure" : "");
}

}  // namespace posevote::server
