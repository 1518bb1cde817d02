// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: signals and files by which a run is asked for a checkpoint or to end.

#ifndef tanktread_base_stop_request_h
#define tanktread_base_stop_request_h

namespace tanktread
{
  /** What somebody has asked a running program for. */
  enum class Request
  {
    none,
    checkpoint, // SIGUSR1
    stop        // SIGTERM: a checkpoint, and the end
  };

  /** From now on these signals are noted instead of ending the program. May be called again. */
  void
  note_requests();

  /** The strongest request since the last call. On the rank that got the signal. */
  Request
  take_request();
} // namespace tanktread

#endif
