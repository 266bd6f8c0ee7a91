// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/log.hpp"

#include <cerrno>
#include <cstring>
#include <optional>

#include "garrison/version.hpp"

namespace garrison::node {

namespace {

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
enum Code : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  attachment = 9,
  data_end = 15
};
constexpr std::size_t kRecordHead = 9;
constexpr std::size_t kMessageHead = 22;
constexpr std::uint16_t kCalls = 1, kSamples = 2;
constexpr std::string_view kProfile = "garrison-node-1";
constexpr std::string_view kJournal = "garrison-journal-1";

Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

/// The content of a record.
class Content {
 public:
  template <class T>
  Content& number(T value) {
    std::array<std::byte, sizeof(T)> bytes;
    wire::store(bytes.data(), value);
    return raw(bytes);
  }
  Content& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    return raw(bytes_of(text));
  }
  Content& raw(Bytes bytes) {
    all_.insert(all_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  operator Bytes() const { return all_; }  // NOLINT: what it is for

 private:
  std::vector<std::byte> all_;
};

Content channel_record(std::uint16_t id, std::uint16_t schema, std::string_view topic,
                       std::string_view encoding) {
  return Content().number(id).number(schema).text(topic).text(encoding).number(std::uint32_t{0});
}

/// The next whole record; false at the end, or where the file was cut.
bool next_record(Bytes& rest, std::uint8_t& code, Bytes& content) {
  if (rest.size() < kRecordHead) return false;
  const auto size = wire::load<std::uint64_t>(rest.data() + 1);
  if (size > rest.size() - kRecordHead) return false;
  code = wire::load<std::uint8_t>(rest.data());
  content = rest.subspan(kRecordHead, static_cast<std::size_t>(size));
  rest = rest.subspan(kRecordHead + content.size());
  return true;
}

/// A text, or bytes behind a size of type T, that `content` begins with.
template <class T>
std::optional<Bytes> piece(Bytes& content) {
  if (content.size() < sizeof(T)) return {};
  const auto size = wire::load<T>(content.data());
  if (size > content.size() - sizeof(T)) return {};
  const Bytes found = content.subspan(sizeof(T), static_cast<std::size_t>(size));
  content = content.subspan(sizeof(T) + found.size());
  return found;
}

bool is(const std::optional<Bytes>& piece, std::string_view text) {
  return piece && std::equal(piece->begin(), piece->end(), bytes_of(text).begin(), bytes_of(text).end());
}

/// The data of an attachment of this name.
std::optional<Bytes> attached(Bytes content, std::string_view name) {
  if (content.size() < 16) return {};
  content = content.subspan(16);  // two times
  const bool meant = is(piece<std::uint32_t>(content), name);
  if (!meant || !piece<std::uint32_t>(content)) return {};
  return piece<std::uint64_t>(content);
}

}  // namespace

LogWriter::LogWriter(const std::string& path, std::string_view node, Bytes part)
    : file_(std::fopen(path.c_str(), "wbxe")) {
  if (!file_)
    throw IoError(path + ": got " + std::strerror(errno) + ", expected a new file that can be written");
  write(std::as_bytes(std::span(kMagic)));
  record(header, Content().text(kProfile).text("garrison " GARRISON_VERSION ", node " + std::string(node)));
  record(attachment, Content()
                         .number(std::uint64_t{0})
                         .number(std::uint64_t{0})
                         .text("part")
                         .text("application/octet-stream")
                         .number(static_cast<std::uint64_t>(part.size()))
                         .raw(part)
                         .number(std::uint32_t{0}));
  record(schema, Content()
                     .number(std::uint16_t{1})
                     .text("garrison.Sample")
                     .text("jsonschema")
                     .text(R"({"type":"object"})"));
  record(channel, channel_record(kCalls, 0, "calls", kJournal));
  record(channel, channel_record(kSamples, 1, "samples", "json"));
}

LogWriter::~LogWriter() {
  if (!file_) return;
  record(data_end, Content().number(std::uint32_t{0}));
  record(footer, Content().number(std::uint64_t{0}).number(std::uint64_t{0}).number(std::uint32_t{0}));
  write(std::as_bytes(std::span(kMagic)));
}

void LogWriter::sample(std::string_view json, Micros wall) { message(kSamples, bytes_of(json), wall); }

void LogWriter::message(std::uint16_t channel, Bytes data, Micros wall) {
  room_.resize(kMessageHead);
  wire::store(room_.data(), channel);
  wire::store(room_.data() + 2, sequence_++);
  wire::store(room_.data() + 6, static_cast<std::uint64_t>(1000 * wall));
  wire::store(room_.data() + 14, static_cast<std::uint64_t>(1000 * wall));
  room_.insert(room_.end(), data.begin(), data.end());
  record(Code::message, room_);
}

void LogWriter::record(std::uint8_t code, Bytes content) {
  std::array<std::byte, kRecordHead> head;
  wire::store(head.data(), code);
  wire::store(head.data() + 1, static_cast<std::uint64_t>(content.size()));
  write(head);
  write(content);
}

/// After a failure nothing more is written: behind a hole it could not be read.
void LogWriter::write(Bytes bytes) noexcept {
  if (failed_ != 0) {
    ++failed_;
    return;
  }
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) ++failed_;
  bytes_ += static_cast<std::int64_t>(bytes.size());
}
void LogWriter::flush() noexcept {
  if (std::fflush(file_.get()) != 0) ++failed_;
}

LogReplay replay_log(Bytes file, const AgentMaker& make) {
  const Bytes magic = std::as_bytes(std::span(kMagic));
  const char* expected = "a log that garrison-node wrote (MCAP)";
  if (file.size() < magic.size() || !std::equal(magic.begin(), magic.end(), file.begin()))
    refuse("log", amount(file.size(), "byte") + " that do not begin like one", expected);
  LogReplay out;
  std::unique_ptr<Agent> agent;
  std::optional<Replay> replay;
  Bytes rest = file.subspan(magic.size());
  Bytes content;
  Entry entry;
  std::size_t size = 0;
  for (std::uint8_t code = 0; next_record(rest, code, content);) {
    if (code == attachment && !agent) {
      const auto part = attached(content, "part");
      if (!part) continue;
      agent = make(*part);
      if (!agent) refuse("log", "a part that is not for this program", expected);
      replay.emplace(*agent);
    }
    if (code == data_end) out.ended = true;
    const bool call = code == message && content.size() > kMessageHead &&
                      wire::load<std::uint16_t>(content.data()) == kCalls;
    if (!call) continue;
    if (!replay) refuse("log", "calls before the agent's part of the design", expected);
    if (!read_entry(content.subspan(kMessageHead), entry, size) || size != content.size() - kMessageHead)
      refuse("log", "a call that cannot be read, after " + std::to_string(out.calls), expected);
    (*replay)(entry);
    ++out.calls;
    if (entry.call != Call::estimate) continue;
    if (out.estimates++ == 0) out.first = entry.sample;
    out.last = entry.sample;
  }
  if (!agent) refuse("log", "no part of a design", expected);
  out.agent = agent->id();
  out.family = agent->family();
  out.wrong = replay->wrong();
  return out;
}

}  // namespace garrison::node
