// posevote serve: the studio for browsers, and the same for programs.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>

#include "command.hpp"
#include "database.hpp"
#include "posevote/core/error.hpp"
#include "server.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct ServeArguments {
  std::string database, listen = "127.0.0.1:8080", token_file, folder, preset = "default", features;
  std::optional<std::string> tls_cert, tls_key;
  std::vector<std::string> cameras, hosts, settings;
  double fps = 5;
};

struct Address {
  std::string host;
  int port = 0;
};

Address parse_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  std::string host = text.substr(0, std::min(colon, text.size()));
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const bool number = !port.empty() && port.size() <= 5 &&
                      port.find_first_not_of("0123456789") == std::string::npos;
  if (host.empty() || !number || std::stoi(port) > 65535)
    wrong_usage("--listen needs HOST:PORT, e.g. 127.0.0.1:8080, not '" + text + "'");
  return {host, std::stoi(port)};
}

/// From --token-file, else $POSEVOTE_TOKEN: never from the command line, which all users can see.
std::string read_token(const std::string& path) {
  std::string token;
  if (path.empty()) {
    const char* value = std::getenv("POSEVOTE_TOKEN");
    token = value ? value : "";
    if (token.empty()) return token;
  } else {
    std::ifstream file(path);
    if (!std::getline(file, token))
      throw Error(ErrorCode::io, "cannot read a token from file '" + path + "'");
  }
  constexpr std::size_t kShortest = 16;
  if (token.size() < kShortest)
    throw Error(
        ErrorCode::invalid_argument,
        "the token is too short; take 16 characters or more, e.g. of: openssl rand -hex 16");
  return token;
}

std::string state_folder(const ServeArguments& arguments, const ObjectStore& store) {
  if (!arguments.folder.empty()) return arguments.folder;
  if (store.location().find("://") != std::string::npos)
    throw Error(ErrorCode::invalid_argument,
                "the database is no file that settings and teach sessions could be kept beside; "
                "name a folder for them with --state");
  return store.location() + ".studio";
}

server::StudioConfig configure(const ServeArguments& arguments) {
  server::StudioConfig config;
  config.store = open_database(arguments.database, Access::create);
  config.folder = state_folder(arguments, *config.store);
  config.options.recognize = make_preset(arguments.preset);
  choose_features(config.options.recognize.feature, config.store.get(), arguments.features);
  apply_settings(list_options(config.options), arguments.settings);
  require_features(config.options.recognize.feature, *config.store);
  for (const std::string& camera : arguments.cameras)
    config.sources.push_back(server::parse_source(camera));
  config.folder_fps = arguments.fps;
  config.access.hosts = arguments.hosts;
  config.version = POSEVOTE_VERSION;
  config.report = print_error;
  return config;
}

/// Signals that end the server, held back from all threads that are begun from now on.
sigset_t hold_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void run(const ServeArguments& arguments) {
  const Address address = parse_address(arguments.listen);
  server::StudioConfig config = configure(arguments);
  config.access.token = read_token(arguments.token_file);
  config.access.any_host = !config.access.token.empty();
  if (config.access.token.empty() && !server::is_loopback(address.host))
    throw Error(ErrorCode::invalid_argument,
                "whoever reaches " + address.host +
                    " could do everything; protect it with a token: --token-file FILE, or the "
                    "environment variable POSEVOTE_TOKEN");
  std::unique_ptr<const server::Certificate> certificate;
  if (arguments.tls_cert)
    certificate = std::make_unique<server::Certificate>(*arguments.tls_cert, *arguments.tls_key);
  const bool https = config.access.https = certificate != nullptr;
  const sigset_t signals = hold_signals();
  const std::string place = config.store->location();
  server::Server server(std::move(config));
  const int port = server.start(address.host, address.port, std::move(certificate));
  const bool v6 = address.host.find(':') != std::string::npos;
  std::cout << (https ? "https://" : "http://") << (v6 ? "[" + address.host + "]" : address.host)
            << ':' << port << "/ serves " << place << "; Ctrl-C ends it" << std::endl;
  int signal = 0;
  sigwait(&signals, &signal);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // who cannot wait asks twice
  server.stop();
}

}  // namespace

void add_serve(CLI::App& app, CommandContext&) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command =
      add_command(app, "serve", "Teach and watch in the browser; the same for programs over HTTP",
                  "  posevote serve --camera 0    then open http://127.0.0.1:8080/\n"
                  "  posevote serve --camera rtsp://robot/head --camera pictures/ --fps 2\n"
                  "  posevote serve --camera 0 --listen 0.0.0.0:8080 --token-file token.txt\n"
                  "  posevote serve --set limits.sessions=2 --set recognize.match.max_ratio=0.8");
  ServeArguments& a = *arguments;
  command
      ->add_option(
          "--camera", a.cameras,
          "Where pictures come from: number of a camera, address of a stream (rtsp, http), "
          "video file, folder of pictures, or client. May be repeated: the page lets "
          "people choose, the first is the one to begin with. Default: client, i.e. "
          "pictures that browsers send")
      ->type_name("SOURCE")
      ->allow_extra_args(false);
  command->add_option("--fps", a.fps, "Pictures a second of folders")
      ->check(CLI::Range(0.2, 100.0))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--listen", a.listen,
                   "Address and port; port 0 takes a free one. Addresses that others can reach "
                   "need a token")
      ->type_name("HOST:PORT")
      ->capture_default_str();
  command
      ->add_option(
          "--token-file", a.token_file,
          "Demand the token in the first line of FILE; default: $POSEVOTE_TOKEN, else none")
      ->type_name("FILE");
  CLI::Option* certificate =
      command
          ->add_option("--tls-cert", a.tls_cert,
                       "Serve https with the certificate in FILE (PEM), as browsers demand it for "
                       "a phone's camera; see docs/server.md")
          ->type_name("FILE");
  CLI::Option* key =
      command
          ->add_option("--tls-key", a.tls_key, "The certificate's private key, without passphrase")
          ->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
  command
      ->add_option("--state", a.folder,
                   "Where settings, teach sessions in hand and deletions are kept; default: beside "
                   "the database's file")
      ->type_name("FOLDER");
  command
      ->add_option("--host", a.hosts,
                   "A name under which this server may be reached without a token, e.g. through a "
                   "proxy; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_preset(*command, a.preset);
  add_features(*command, a.features);
  command
      ->add_option(
          "--set", a.settings,
          "Change an option: recognize.NAME, teach.NAME (see posevote options), live.NAME, "
          "limits.NAME (see docs/server.md)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  add_database(*command, a.database);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace posevote::cli
