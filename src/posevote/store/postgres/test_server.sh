#!/bin/sh
# A PostgreSQL server for tests, in a folder of its own, on loopback and on a Unix socket.
#   test_server.sh start|stop BIN FILE
# BIN holds initdb and pg_ctl; FILE gets three lines: the server's folder, its port, its socket's
# folder. PostgreSQL refuses to run as root: then the user postgres does it, or nobody.
set -eu
action=$1 bin=$2 file=$3

as_server() {
  if [ "$(id -u)" -ne 0 ]; then
    "$@"
    return
  fi
  user=nobody
  id postgres >/dev/null 2>&1 && user=postgres
  (cd / && setpriv --reuid "$user" --regid "$(id -g "$user")" --clear-groups "$@")
}

stop() {
  [ -r "$file" ] || return 0
  folder=$(sed -n 1p "$file")
  as_server "$bin/pg_ctl" -D "$folder/data" -m immediate stop >/dev/null 2>&1 || true
  rm -rf "$folder" "$file"
}

start() {
  stop
  folder=$(mktemp -d /tmp/posevote-postgres.XXXXXX)
  chmod 755 "$folder"
  mkdir "$folder/data"
  if [ "$(id -u)" -eq 0 ]; then
    id postgres >/dev/null 2>&1 && chown -R postgres "$folder" || chown -R nobody "$folder"
  fi
  as_server "$bin/initdb" -D "$folder/data" -U tester -E UTF8 --locale C.UTF-8 --no-sync \
    --auth-local trust --auth-host scram-sha-256 >"$folder.log" 2>&1 ||
    { cat "$folder.log" && exit 1; }
  rm -f "$folder.log"
  port=$((20000 + $$ % 30000))
  for attempt in 1 2 3 4 5; do
    # What is lost when the machine goes down matters to nobody here.
    if as_server "$bin/pg_ctl" -D "$folder/data" -l "$folder/log" -w -t 120 start -o "-p $port \
      -c listen_addresses=127.0.0.1 -c unix_socket_directories=$folder -c fsync=off \
      -c full_page_writes=off -c max_connections=100 -c shared_buffers=32MB" >/dev/null; then
      printf '%s\n%s\n%s\n' "$folder" "$port" "$folder" >"$file"
      return 0
    fi
    port=$((port + attempt * 101))
  done
  cat "$folder/log"
  return 1
}

"$action"
