// A sweep on several processes, on one machine or many, started by `mpirun -n N beamid sweep ...`.
//
// The first process hands out the cases one by one and keeps what comes back; the others ask for a case, run
// it, send its rows and thereby ask for the next. Whoever is faster gets more. The first needs hardly any
// processor time: N processes compute on N - 1 cores.
#pragma once

#include <functional>
#include <string>

#include "experiments/sweep/sweep.hpp"

namespace beamid::experiments {

/// The processes that mpirun has started together with this one. There is one only where it was not mpirun
/// that started it, or beamid was built without MPI, which is then not touched.
class Processes {
 public:
  /// @throws std::runtime_error when mpirun has started several and beamid was built without MPI: each would
  /// run the whole sweep.
  Processes();
  ~Processes();  ///< of the first process: sends home those that are still waiting
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  int count() const { return count_; }
  bool first() const { return rank_ == 0; }

  /// In the first process, as run_cases(): the cases of the queue, run by the others. The sink's exception,
  /// or trouble of another process, stops the rest and is thrown when all have ended.
  /// @param job what the others have to know, any bytes
  void run(CaseQueue& queue, const SweepPlan& plan, const std::string& job, const CaseSink& sink);

  /// In the others: waits for a job and runs what is handed out, until there is nothing left.
  /// @param prepare makes of the job what runs its cases; an exception of either is told to the first.
  void work(const std::function<CaseRunner(const std::string& job)>& prepare);

 private:
  int count_ = 1, rank_ = 0;
  int waiting_ = 0;  ///< others that have not been sent home
  bool started_ = false;
};

}  // namespace beamid::experiments
