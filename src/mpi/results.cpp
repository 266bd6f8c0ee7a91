// SPDX-License-Identifier: Apache-2.0
#include "mpi/results.hpp"

#include <fcntl.h>
#include <pnetcdf.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "garrison/version.hpp"
#include "mpi/here.hpp"
#include "mpi/together.hpp"
#include "node/daemon/files.hpp"

namespace garrison::mpi {
namespace {

constexpr const char* kChanged = "it was changed: start with --force, not --resume";

std::string hex(std::uint64_t value) {
  std::array<char, 17> out{};
  std::snprintf(out.data(), out.size(), "%016llx", static_cast<unsigned long long>(value));
  return out.data();
}

/// Takes the bytes from..to of a file from the disk; the error's number where there is no room, 0 when done.
int take_room(const std::string& path, std::uintmax_t from, std::uintmax_t to) {
  const node::Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file) return errno;
  if (::fallocate(file.get(), 0, static_cast<off_t>(from), static_cast<off_t>(to - from)) == 0) return 0;
  if (errno != EOPNOTSUPP && errno != ENOSYS) return errno;
  struct statvfs disk{};  // of a file system that promises nothing: what is free now
  if (::fstatvfs(file.get(), &disk) == 0 && disk.f_bavail < (to - from) / disk.f_frsize) return ENOSPC;
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) < to && !failed)
    std::filesystem::resize_file(path, to, failed);
  return failed.value();
}

}  // namespace

Results::Results(const std::string& path, const Scenario& scenario, bool resume)
    : path_(path), every_(scenario.every), estimates_(scenario.kept == Kept::estimates) {
  resume ? open(scenario) : create(scenario);
}

Results::~Results() {
  if (file_ >= 0) ncmpi_close(file_);
}

void Results::check(int code, const char* what, const char* advice) {
  if (code != NC_NOERR && failure_.empty())
    failure_ = path_ + ": got " + ncmpi_strerror(code) + ", expected to " + what + "; " + advice;
}
void Results::settle() { agree(std::exchange(failure_, {})); }

void Results::create(const Scenario& s) {
  check(ncmpi_create(MPI_COMM_WORLD, path_.c_str(), NC_CLOBBER | NC_64BIT_OFFSET, MPI_INFO_NULL, &file_),
        "make it");
  settle();
  int time = 0;
  int state = 0;
  int agent = 0;
  check(ncmpi_def_dim(file_, "time", NC_UNLIMITED, &time), "describe it");
  check(ncmpi_def_dim(file_, "state", s.states(), &state), "describe it");
  const auto variable = [&](const char* name, nc_type type, std::initializer_list<int> dims,
                            const char* says) {
    int id = -1;
    check(ncmpi_def_var(file_, name, type, static_cast<int>(dims.size()), dims.begin(), &id), "describe it");
    check(ncmpi_put_att_text(file_, id, "long_name", static_cast<MPI_Offset>(std::string(says).size()), says),
          "describe it");
    return id;
  };
  time_ = variable("time", NC_INT, {time}, "sample, 0 being the start");
  truth_ = variable("truth", NC_DOUBLE, {time, state}, "state of the plant");
  mean_ = variable("error_mean", NC_DOUBLE, {time}, "mean over all agents of |estimate - truth|");
  largest_ = variable("error_largest", NC_DOUBLE, {time}, "largest over all agents");
  median_ = variable("error_median", NC_DOUBLE, {time}, "median over all agents, rounded up by at most 1 %");
  q95_ = variable("error_q95", NC_DOUBLE, {time}, "95 % quantile over all agents, rounded up by at most 1 %");
  if (estimates_) {
    check(ncmpi_def_dim(file_, "agent", s.agents(), &agent), "describe it");
    estimate_ = variable("estimate", NC_DOUBLE, {time, agent, state}, "estimates, agents by public id");
  }
  const auto note = [&](const char* name, const std::string& value) {
    check(ncmpi_put_att_text(file_, NC_GLOBAL, name, static_cast<MPI_Offset>(value.size()), value.c_str()),
          "describe it");
  };
  note("source", "garrison-mpi " GARRISON_VERSION);
  note("filter", s.family);
  note("network", s.ground->description());
  note("scenario_checksum", hex(s.fingerprint));
  check(ncmpi_enddef(file_), "describe it");
  if (this_rank() == 0) make_room(0, length_of(0));
  settle();
}

void Results::open(const Scenario& s) {
  const int code = ncmpi_open(MPI_COMM_WORLD, path_.c_str(), NC_WRITE, MPI_INFO_NULL, &file_);
  if (code != NC_NOERR)
    failure_ = path_ + ": got " + ncmpi_strerror(code) +
               ", expected the results that are gone on with; start without --resume, with another -o";
  settle();
  std::string checksum(16, ' ');
  MPI_Offset length = 0;
  if (ncmpi_inq_attlen(file_, NC_GLOBAL, "scenario_checksum", &length) != NC_NOERR || length != 16 ||
      ncmpi_get_att_text(file_, NC_GLOBAL, "scenario_checksum", checksum.data()) != NC_NOERR ||
      checksum != hex(s.fingerprint))
    failure_ = path_ + ": got a file of another scenario, expected the results of " + s.path +
               " as it is now; use another -o without --resume";
  settle();
  const auto id_of = [&](const char* name) {
    int id = -1;
    check(ncmpi_inq_varid(file_, name, &id), "find its variables", kChanged);
    return id;
  };
  time_ = id_of("time");
  truth_ = id_of("truth");
  mean_ = id_of("error_mean");
  largest_ = id_of("error_largest");
  median_ = id_of("error_median");
  q95_ = id_of("error_q95");
  if (estimates_) estimate_ = id_of("estimate");
  settle();
}

void Results::write(std::int64_t t, std::span<const double> truth, const Summary& summary,
                    const PublicOrder& order, std::span<const double> estimates) {
  const MPI_Offset record = t / every_ - 1;
  const bool first = this_rank() == 0;
  if (first) make_room(length_of(record), length_of(record + 1));
  settle();
  // Collective: ranks that have nothing of a variable write no numbers of it.
  const MPI_Offset one = first ? 1 : 0;
  const int time = static_cast<int>(t);
  check(ncmpi_iput_vara_int(file_, time_, &record, &one, &time, nullptr), "write into it");
  const std::array<std::pair<int, double>, 4> numbers{
      {{mean_, summary.mean}, {largest_, summary.largest}, {median_, summary.median}, {q95_, summary.q95}}};
  for (const auto& [id, value] : numbers)
    check(ncmpi_iput_vara_double(file_, id, &record, &one, &value, nullptr), "write into it");
  const auto n = static_cast<MPI_Offset>(truth.size());
  const std::array<MPI_Offset, 2> at{record, 0};
  const std::array<MPI_Offset, 2> size{one, first ? n : 0};
  check(ncmpi_iput_vara_double(file_, truth_, at.data(), size.data(), truth.data(), nullptr),
        "write into it");
  const bool some = order.last() > order.first();
  const std::array<MPI_Offset, 3> from{record, some ? order.first() : 0, 0};
  const std::array<MPI_Offset, 3> count{some ? 1 : 0, order.last() - order.first(), n};
  if (estimates_)
    check(ncmpi_iput_vara_double(file_, estimate_, from.data(), count.data(), estimates.data(), nullptr),
          "write into it");
  check(ncmpi_wait_all(file_, NC_REQ_ALL, nullptr, nullptr), "write into it");
  settle();
}

/// Rank 0 counts the record in the header, and others may be killed before their part of it is written: the
/// file is as long as the header says even then, with zeros in place of what is missing, and can be read. And
/// MPI libraries do not tell of a disk that became full while they wrote (OpenMPI 4.1): nobody writes before
/// the room is there.
void Results::make_room(std::uintmax_t from, std::uintmax_t to) {
  const int failed = take_room(path_, from, to);
  if (failed != 0 && failure_.empty())
    failure_ = path_ + ": got " + std::strerror(failed) + ", expected room for " + amount(to - from, "byte") +
               " more; free the disk";
}

std::uintmax_t Results::length_of(MPI_Offset records) {
  MPI_Offset begin = 0;
  MPI_Offset size = 0;
  check(ncmpi_inq_varoffset(file_, time_, &begin), "find its records", kChanged);
  check(ncmpi_inq_recsize(file_, &size), "find its records", kChanged);
  return static_cast<std::uintmax_t>(begin + records * size);
}

void Results::require_until(std::int64_t t) {
  const MPI_Offset records = t / every_;
  MPI_Offset written = 0;
  int time = -1;
  check(ncmpi_inq_dimid(file_, "time", &time), "find its records", kChanged);
  settle();
  check(ncmpi_inq_dimlen(file_, time, &written), "find its records", kChanged);
  const std::uintmax_t needed = length_of(written);
  settle();
  std::error_code failed;
  bool whole = written >= records && std::filesystem::file_size(path_, failed) >= needed && !failed;
  std::vector<int> times(static_cast<std::size_t>(whole ? records : 0));
  const MPI_Offset first = 0;
  const auto count = static_cast<MPI_Offset>(times.size());
  check(ncmpi_get_vara_int_all(file_, time_, &first, &count, times.data()), "read its samples", kChanged);
  for (std::size_t k = 0; k < times.size(); ++k) whole &= times[k] == static_cast<int>(k + 1) * every_;
  if (!whole && failure_.empty())
    failure_ = path_ + ": got results that do not hold all samples up to " + std::to_string(t) +
               ", where the checkpoint is, expected those of the run that wrote it; start without --resume";
  settle();
}

void Results::sync() {
  check(ncmpi_sync(file_), "write it to the disk");
  settle();
}

}  // namespace garrison::mpi
