// SPDX-License-Identifier: Apache-2.0
// What the desk answers on the local socket.
#include "node/daemon/desk.hpp"
#include "node/daemon/json.hpp"

namespace garrison::node {

namespace {
constexpr const char* kBegun = "a node that has begun";

std::string error_line(const std::string& which, const std::string& expected) {
  return Json().open('{').key("error").word(which).key("expected").word(expected).close('}').take();
}
}  // namespace

std::string Desk::answer(std::string_view request) {
  if (request == "status") {
    if (loop_ == nullptr) return error_line("a clock that is not synchronised", kBegun);
    if (!known_) return error_line("no status yet", kBegun);
    around_.sensor = sensor_->counters();
    around_.snapshot_age = stored_at_ < 0 ? -1 : now().steady - stored_at_;
    return status_json(status_, around_);
  }
  if (request.starts_with("y ")) return measured(request.substr(2));
  if (request == "reload") return reload();
  return error_line("an unknown request", "status, watch, reload, or y and numbers");
}

std::string Desk::measured(std::string_view line) {
  if (!sensor_->takes_lines_from_clients())
    return error_line("y", R"(a node with [sensor] source = "socket")");
  const std::int64_t before = sensor_->counters().taken;
  sensor_->line(line, now().wall);
  if (sensor_->counters().taken > before) return kOk;
  return error_line("y", "as many numbers as the agent has outputs, nan where one is missing");
}

/// Takes over what may change while the node runs: where measurements come from, and how much is kept.
std::string Desk::reload() {
  if (loop_ == nullptr) return error_line("a clock that is not synchronised", kBegun);
  if (former_) return error_line("reload", "a moment since the last one");
  try {
    const Station next = read_station(station_.settings.file);
    require_same_run(station_, next);
    auto sensor = std::make_unique<Sensor>(
        next.settings.sensor, static_cast<std::size_t>(station_.agent->outputs()), station_.settings.file);
    former_ = std::exchange(sensor_, std::move(sensor));
    former_until_ = loop_->turns() + 1;
    loop_->use(*sensor_);
    station_.settings.log_bytes = next.settings.log_bytes;
    station_.settings.state_every = next.settings.state_every;
    if (log_) log_->keep(next.settings.log_files);
    return kOk;
  } catch (const Error& error) {
    return error_line(error.what(), "files that garrison-node --check takes");
  }
}

}  // namespace garrison::node
