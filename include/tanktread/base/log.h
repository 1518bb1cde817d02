// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run tells on the screen and in log.txt.

#ifndef tanktread_base_log_h
#define tanktread_base_log_h

#include <fstream>
#include <iosfwd>
#include <string>
#include <vector>

namespace tanktread
{
  class Timings;

  /** What the first lines of the log say. */
  struct RunDescription
  {
    std::string  parameter_file;
    unsigned int n_ranks = 1;
    std::string  flow;            // "shear"
    bool         has_rate = true; // time in 1/gamma, otherwise in mu a^3 / kappa_B
    double       G        = 0.;   // mu gamma a / (E h); unused without a rate
    double       khat     = 0.;   // kappa_B / (a^2 E h)
    std::string  box;             // its sides in a: "10 x 10 x 10"
    unsigned int n_capsules = 1;
    std::string  kinds;   // which capsules are of which kind; empty if all are of one
    double       Re = 0.; // Reynolds number; 0: no line

    std::vector<std::string> included; // physics that the scene asks for beyond the simplest
    std::vector<std::string> left_out; // what the scene does not need: "inertia (Re = 0)"
  };

  /** One line of the table of steps. A number that is not finite is printed as "-". */
  struct StepLine
  {
    unsigned int step              = 0;
    double       time              = 0.;
    double       dt                = 0.;
    unsigned int newton            = 0;  // iterations
    unsigned int linear            = 0;  // iterations
    double       D                 = 0.; // Taylor parameter D_xz
    double       theta_over_pi     = 0.; // inclination
    double       volume_error      = 0.; // relative
    double       remaining_seconds = 0.; // estimated wall time to the end
  };

  /**
   * Writes plain text to the screen and, once open() has been called, to a file. Everything before open() goes to the file as well. An inactive log (on all
   * ranks but the first) writes nothing.
   */
  class Log
  {
  public:
    /** Writes to std::cout. */
    explicit Log(bool active);

    /** Writes to `screen`, which has to live longer than the log. */
    Log(bool active, std::ostream &screen);

    /**
     * From now on also writes to `file_name`. @throws OutputError when it cannot be written; when that happens later the screen says so, and the run goes on.
     */
    void
    open(const std::string &file_name);

    /** The same for the log of a run that goes on, cut off after its first `size` bytes. */
    void
    reopen(const std::string &file_name, std::streamoff size);

    /** Bytes of the file. */
    std::streamoff
    written();

    /** Versions, ranks, date, scales and what the scene leaves out. */
    void
    header(const RunDescription &run);

    /** One line of free text. */
    void
    line(const std::string &text);

    /** One step; names of the columns stand above the first and above every 20th. */
    void
    step(const StepLine &step);

    /** Table of wall times. */
    void
    timings(const Timings &timings);

  private:
    const bool    active;
    std::ostream &screen;
    std::ofstream file;
    std::string   name, before_open; // of the file; what is to go into it
    unsigned int  n_steps = 0;
  };

  /** Seconds as "h:mm:ss", or "-" for a negative number or one that is not finite. */
  std::string
  duration_text(double seconds);
} // namespace tanktread

#endif
