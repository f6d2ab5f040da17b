#include "http/http_server.hpp"

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>

#include "http/problem.hpp"
#include "http/socket_stream.hpp"

namespace posevote::server {
namespace {

/// The request that this thread answers.
struct Exchange {
  SocketStream& stream;
  const std::atomic<bool>& stopping;
  bool understood = false;    ///< its head was
  bool body_pending = false;  ///< a body was announced and not read to its end
};
thread_local Exchange* exchange = nullptr;
thread_local bool turning_away = false;

/// A thread for each connection, up to a limit.
class ConnectionThreads : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(int limit) : limit_(limit), state_(std::make_shared<State>()) {}

  void enqueue(std::function<void()> connection) override {
    {
      const std::lock_guard lock(state_->mutex);
      turning_away = state_->running == limit_;
      if (!turning_away) ++state_->running;
    }
    if (turning_away) return connection();
    std::thread([state = state_, connection = std::move(connection)] {
      connection();
      const std::lock_guard lock(state->mutex);
      --state->running;
      state->ended.notify_all();
    }).detach();
  }

  void shutdown() override {
    std::unique_lock lock(state_->mutex);
    state_->ended.wait(lock, [this] { return state_->running == 0; });
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable ended;
    int running = 0;
  };
  int limit_;
  std::shared_ptr<State> state_;
};

class StreamSink : public Sink {
 public:
  StreamSink(httplib::DataSink& sink, Exchange& of) : sink_(sink), exchange_(of) {}
  bool write(const std::string& data) override {
    return !closed() && sink_.write(data.data(), data.size());
  }
  bool closed() override { return exchange_.stopping || exchange_.stream.peer_gone(); }

 private:
  httplib::DataSink& sink_;
  Exchange& exchange_;
};

/// Bytes of all bodies in memory: those that arrive, wait and are worked on.
class BodyBudget {
 public:
  explicit BodyBudget(double megabytes) : left_(static_cast<std::int64_t>(megabytes * 1e6)) {}

  class Share {
   public:
    explicit Share(BodyBudget& budget) : budget_(budget) {}
    ~Share() { budget_.left_ += taken_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    void take(std::size_t bytes) {
      taken_ += static_cast<std::int64_t>(bytes);
      if ((budget_.left_ -= static_cast<std::int64_t>(bytes)) < 0) throw busy();
    }

   private:
    BodyBudget& budget_;
    std::int64_t taken_ = 0;
  };

 private:
  std::atomic<std::int64_t> left_;
};

Problem too_large(std::size_t max_bytes) {
  const double megabytes = static_cast<double>(max_bytes) / 1e6;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", megabytes);
  return {413, "too_large", std::string("the request's body is larger than ") + text + " MB"};
}

}  // namespace

class HttpServer::Listener : public httplib::Server {
 public:
  Listener(const Limits& limits, RequestHandler handler)
      : limits_(limits), handler_(std::move(handler)), budget_(limits.bodies_mb) {
    new_task_queue = [this] { return new ConnectionThreads(limits_.connections); };
    const auto without_body = [this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response, nullptr);
    };
    const auto with_body = [this](const httplib::Request& request, httplib::Response& response,
                                  const httplib::ContentReader& reader) {
      answer(request, response, &reader);
    };
    // Every path has become "/", see `process_and_close_socket`.
    Get("/", without_body);
    Options("/", without_body);
    Post("/", with_body);
    Put("/", with_body);
    Patch("/", with_body);
    Delete("/", with_body);
    set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty())
        response.set_content(problem_json(invalid("this is no HTTP request that can be answered")),
                             "application/json");
    });
    set_socket_options([](socket_t socket) {
      const int on = 1;  // never SO_REUSEPORT: a second server must not share the port unnoticed
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    });
  }

  ~Listener() override { halt(); }

  int start(const std::string& host, int port, std::unique_ptr<const Certificate> certificate) {
    certificate_ = std::move(certificate);
    errno = 0;
    const int bound = port == 0 ? bind_to_any_port(host) : (bind_to_port(host, port) ? port : -1);
    if (bound <= 0)
      throw Error(ErrorCode::io, "cannot listen on " + host + ":" + std::to_string(port) + ": " +
                                     (errno ? std::strerror(errno) : "no such address"));
    thread_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::yield();
    return bound;
  }

  void halt() {
    stopping_ = true;
    if (!thread_.joinable()) return;
    stop();
    thread_.join();
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    if (turning_away) {
      const SocketStream closes(socket, limits_, stopping_, nullptr);
      if (!certificate_)  // a handshake would hold others up
        answer_plainly(socket, {503, "busy", "there are too many connections; try again later"});
      return true;
    }
    SocketStream stream(socket, limits_, stopping_, certificate_.get());
    while (!stopping_ && stream.wait_for_request()) {
      Exchange now{stream, stopping_};
      exchange = &now;
      bool closed = false;
      const bool answered = process_request(stream, false, closed,
                                            [&](httplib::Request& request) { prepare(request); });
      exchange = nullptr;
      if (now.body_pending || !now.understood) {
        stream.linger();
        break;
      }
      if (!answered || closed) break;
    }
    if (stream.met_plain_http()) {
      answer_plainly(socket, invalid("this server speaks HTTPS only; open https:// instead"));
      stream.linger();
    }
    return true;
  }

  /// Without the library, at once or not at all.
  static void answer_plainly(socket_t socket, const Problem& problem) {
    const std::string body = problem_json(problem);
    const std::string text = "HTTP/1.1 " + std::to_string(problem.status()) +
                             " Refused\r\nContent-Type: application/json\r\nConnection: close" +
                             (problem.status() == 503 ? "\r\nRetry-After: 5" : "") +
                             "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
                             body;
    send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  /// The library matches paths by regular expressions, which recurse once per character, and after
  /// decoding, which loses the difference of / and %2F. We route by `target` instead.
  static void prepare(httplib::Request& request) {
    exchange->understood = true;
    request.path.assign(1, '/');
    request.ranges.clear();
    request.headers.erase("Accept-Encoding");  // no compression on the fly: the CPU has other work
    exchange->stream.begin_body();
    const auto length = request.get_header_value<std::uint64_t>("Content-Length");
    exchange->body_pending = length > 0 || request.has_header("Transfer-Encoding");
  }

  void answer(const httplib::Request& from, httplib::Response& to,
              const httplib::ContentReader* reader) {
    Response response;
    try {
      Request request = convert(from, to, reader);
      response = handler_(request);
    } catch (...) {
      const Problem problem = to_problem(std::current_exception());
      response.status = problem.status();
      response.type = "application/json";
      response.body = problem_json(problem);
    }
    to.status = response.status;
    for (const auto& [name, value] : response.headers) to.headers.emplace(name, value);
    if (exchange->body_pending) to.headers.emplace("Connection", "close");
    if (response.stream) {
      exchange->stream.prefer_fresh();
      to.set_chunked_content_provider(response.type, [stream = std::move(response.stream)](
                                                         std::size_t, httplib::DataSink& sink) {
        StreamSink out(sink, *exchange);
        stream(out);
        sink.done();
        return true;
      });
    } else if (!response.type.empty()) {
      to.set_content(response.body, response.type);
    }
  }

  Request convert(const httplib::Request& from, httplib::Response& to,
                  const httplib::ContentReader* reader) {
    Request request;
    request.method = from.method == "HEAD" ? "GET" : from.method;
    request.path = from.target.substr(0, from.target.find('?'));
    for (const auto& [name, value] : from.params) request.query.emplace(name, value);
    request.header = [&from](const char* name) { return from.get_header_value(name); };
    request.receive_body = [=, this, &from, &to](std::size_t max_bytes, const Receiver& receive) {
      read(from, to, reader, max_bytes, receive, nullptr);
    };
    request.read_body = [=, this, &from, &to](std::size_t max_bytes) {
      Body body;
      const auto share = std::make_shared<BodyBudget::Share>(budget_);
      body.share = share;
      Bytes* part = &body.raw;
      read(
          from, to, reader, max_bytes,
          [&](const char* data, std::size_t size) {
            share->take(size);
            part->insert(part->end(), data, data + size);
          },
          [&](const std::string& name) {
            part = &body.parts[name];
            constexpr std::size_t kMostParts = 8;
            if (body.parts.size() > kMostParts) throw invalid("the form has too many parts");
          });
      return body;
    };
    return request;
  }

  using Receiver = std::function<void(const char*, std::size_t)>;
  using PartBegin = std::function<void(const std::string& name)>;

  /// `begin_part` is called before each part of multipart/form-data; null: only raw bodies.
  static void read(const httplib::Request& from, httplib::Response& to,
                   const httplib::ContentReader* reader, std::size_t max_bytes,
                   const Receiver& receive, const PartBegin& begin_part) {
    if (!reader || !exchange->body_pending) return;
    if (from.has_header("Content-Encoding"))
      throw invalid("the request's body is compressed; send it as it is");
    if (from.get_header_value<std::uint64_t>("Content-Length") > max_bytes)
      throw too_large(max_bytes);
    const bool in_parts = from.is_multipart_form_data();
    if (in_parts && !begin_part) throw invalid("send the file itself, not a form");
    std::size_t total = 0;
    std::exception_ptr failure;
    const auto guarded = [&](const auto& action) {
      try {
        action();
        return true;
      } catch (...) {
        failure = std::current_exception();
        return false;
      }
    };
    const auto counted = [&](const char* data, std::size_t size) {
      return guarded([&] {
        if ((total += size) > max_bytes) throw too_large(max_bytes);
        receive(data, size);
      });
    };
    const bool complete = in_parts ? (*reader)(
                                         [&](const httplib::MultipartFormData& part) {
                                           return guarded([&] { begin_part(part.name); });
                                         },
                                         counted)
                                   : (*reader)(counted);
    to.status = -1;
    if (failure) std::rethrow_exception(failure);
    if (exchange->stream.timed_out())
      throw Problem(408, "timeout", "the request took too long to arrive");
    if (!complete) throw invalid("the request's body is not complete, or no multipart/form-data");
    exchange->body_pending = false;
  }

  const Limits limits_;
  RequestHandler handler_;
  std::unique_ptr<const Certificate> certificate_;
  BodyBudget budget_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

HttpServer::HttpServer(const Limits& limits, RequestHandler handler)
    : listener_(std::make_unique<Listener>(limits, std::move(handler))) {}

HttpServer::~HttpServer() = default;

int HttpServer::start(const std::string& host, int port,
                      std::unique_ptr<const Certificate> certificate) {
  return listener_->start(host, port, std::move(certificate));
}

void HttpServer::stop() {
  listener_->halt();
}

}  // namespace posevote::server
