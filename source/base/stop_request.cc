// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signals and files by which a run is asked for a checkpoint or to end.

#include <tanktread/base/stop_request.h>

#include <csignal>

namespace tanktread
{
  namespace
  {
    // Signals know of no objects: what they leave behind has to be of the whole program.
    volatile std::sig_atomic_t checkpoint_wanted = 0, stop_wanted = 0;

    extern "C" void
    note(const int signal)
    {
      (signal == SIGUSR1 ? checkpoint_wanted : stop_wanted) = 1;
    }
  } // namespace


  void
  note_requests()
  {
    std::signal(SIGUSR1, note);
    std::signal(SIGTERM, note);
  }


  Request
  take_request()
  {
    const Request result = stop_wanted ? Request::stop : checkpoint_wanted ? Request::checkpoint : Request::none;
    checkpoint_wanted    = 0;
    stop_wanted          = 0;
    return result;
  }
} // namespace tanktread
