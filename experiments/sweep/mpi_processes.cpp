// The one file that uses MPI [mpi31], which is loaded where mpirun has started several processes. Messages
// are bytes: a letter, and what it announces.
//
//     to the first process:  r            ready
//                            d rows       cases are finished: their rows as lines of CSV
//                            t text       trouble
//     from it:               j job        what the sweep is
//                            c numbers    run these cases
//                            s            there is nothing left
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "experiments/sweep/rows.hpp"

#ifdef BEAMID_MPI
#include <mpi.h>

#include <chrono>
#include <iterator>
#include <sstream>
#include <thread>

#include <needed_library.hpp>
#endif

namespace beamid::experiments {
namespace {

/// What mpirun tells a process that it starts: Open MPI, and those that follow PMI (MPICH, Slurm).
int set_by_mpirun() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const value = std::getenv(name)) return std::atoi(value);
  return 1;
}

}  // namespace

#ifdef BEAMID_MPI

namespace {

// Its own modules take functions of it from the program: they are to be seen.
constexpr NeededLibrary mpi{BEAMID_MPI, RTLD_GLOBAL};
BEAMID_NEEDED(mpi, MPI_Init);
BEAMID_NEEDED(mpi, MPI_Finalize);
BEAMID_NEEDED(mpi, MPI_Comm_rank);
BEAMID_NEEDED(mpi, MPI_Comm_size);
BEAMID_NEEDED(mpi, MPI_Send);
BEAMID_NEEDED(mpi, MPI_Recv);
BEAMID_NEEDED(mpi, MPI_Iprobe);
BEAMID_NEEDED(mpi, MPI_Get_count);
#ifdef OPEN_MPI  // what MPI_COMM_WORLD and MPI_CHAR stand for; numbers elsewhere
BEAMID_NEEDED_VARIABLE(mpi, ompi_mpi_comm_world);
BEAMID_NEEDED_VARIABLE(mpi, ompi_mpi_char);
#endif

struct Message {
  int rank = 0;  ///< whose
  char kind = 's';
  std::string text;
};

void send(int rank, char kind, const std::string& text = "") {
  const std::string bytes = kind + text;
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, rank, 0, MPI_COMM_WORLD);
}

/// Waits without keeping a core busy, as MPI_Recv would: what is awaited takes milliseconds at least.
Message receive(int rank) {
  constexpr auto pause = std::chrono::microseconds(100);
  MPI_Status status;
  for (int there = 0;;) {
    MPI_Iprobe(rank, 0, MPI_COMM_WORLD, &there, &status);
    if (there) break;
    std::this_thread::sleep_for(pause);
  }
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  MPI_Recv(bytes.data(), size, MPI_CHAR, status.MPI_SOURCE, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return {status.MPI_SOURCE, bytes.at(0), bytes.substr(1)};
}

std::vector<SweepRow> rows_in(const std::string& lines, std::size_t values) {
  std::vector<SweepRow> rows;
  for (std::size_t begin = 0, end; (end = lines.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const auto row = from_line(std::string_view(lines).substr(begin, end - begin), values);
    if (!row) throw std::runtime_error("another process sent no row of this sweep");
    rows.push_back(*row);
  }
  return rows;
}

CaseBlock numbers_in(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::size_t>(stream), {}};
}

}  // namespace

Processes::Processes() {
  if (set_by_mpirun() < 2) return;
  MPI_Init(nullptr, nullptr);
  started_ = true;
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  if (first()) waiting_ = count_ - 1;
}

Processes::~Processes() {
  if (!started_) return;
  for (; waiting_ > 0; --waiting_) send(receive(MPI_ANY_SOURCE).rank, 's');
  MPI_Finalize();
}

void Processes::run(CaseQueue& queue, const SweepPlan& plan, const std::string& job, const CaseSink& sink) {
  std::exception_ptr trouble;
  while (waiting_ > 0) {
    const Message message = receive(MPI_ANY_SOURCE);
    if (message.kind == 'r') {
      send(message.rank, 'j', job);
      continue;
    }
    try {
      if (message.kind == 't') throw std::runtime_error(message.text);
      if (message.kind == 'd' && !trouble) {
        std::vector<SweepRow> rows = rows_in(message.text, plan.varied.size());
        if (!rows.empty()) sink(std::move(rows));
      }
    } catch (...) {
      queue.stop();
      if (!trouble) trouble = std::current_exception();
    }
    if (CaseBlock block; message.kind != 't' && queue.next(block)) {
      send(message.rank, 'c', fmt::format("{}", fmt::join(block, " ")));
    } else {
      send(message.rank, 's');
      --waiting_;
    }
  }
  if (trouble) std::rethrow_exception(trouble);
}

void Processes::work(const std::function<CaseRunner(const std::string& job)>& prepare) {
  CaseRunner run;
  send(0, 'r');
  for (;;) {
    const Message message = receive(0);
    if (message.kind == 's') return;
    try {
      std::string lines;
      if (message.kind == 'j') {
        run = prepare(message.text);
      } else {
        for (const SweepRow& row : run(numbers_in(message.text))) lines += to_line(row);
      }
      send(0, 'd', lines);
    } catch (const std::exception& error) {
      send(0, 't', fmt::format("process {}: {}", rank_, error.what()));
    }
  }
}

#else

Processes::Processes() {
  if (const int several = set_by_mpirun(); several > 1)
    throw std::runtime_error(
        fmt::format("mpirun has started {} processes, and this beamid was built without MPI (libopenmpi-dev, "
                    "BEAMID_MPI=ON); expected one with it, or --shard I/N",
                    several));
}
Processes::~Processes() = default;
void Processes::run(CaseQueue&, const SweepPlan&, const std::string&, const CaseSink&) {}
void Processes::work(const std::function<CaseRunner(const std::string& job)>&) {}

#endif

}  // namespace beamid::experiments
