// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run tells on the screen and in log.txt.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/log.h>
#include <tanktread/base/output_file.h>
#include <tanktread/base/timings.h>
#include <tanktread/base/version.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>

namespace tanktread
{
  namespace
  {
    std::string
    number(const char *format, const double value)
    {
      if (!std::isfinite(value))
        return "-";
      char text[40];
      std::snprintf(text, sizeof(text), format, value);
      return text;
    }

    std::string
    now()
    {
      const std::time_t time = std::time(nullptr);
      char              text[40];
      std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S", std::localtime(&time));
      return text;
    }

    std::string
    scales_text(const RunDescription &run)
    {
      std::string text = "Lengths in a (radius of the sphere of a capsule's volume), viscosity in mu (outer fluid),\n";
      if (run.has_rate)
        text += "time in 1/gamma (rate of the flow).\n  flow = " + run.flow + "\n  G    = " + number("%-10.6g", run.G) +
          "mu gamma a / (E h)\n  Ca   = " + number("%-10.6g", 3 * run.G) + "mu gamma a / G_s = 3 G\n";
      else
        text += "time in mu a^3 / kappa_B.\n  flow = " + run.flow + "\n";
      text += "  khat = " + number("%-10.6g", run.khat) + "kappa_B / (a^2 E h)\n  box  = " + run.box + "\n";
      if (run.n_capsules > 1)
        text += "  N    = " + std::to_string(run.n_capsules) + " capsules; D_xz and theta below are those of the first, the volume error is the largest\n";
      if (!run.kinds.empty())
        text += "  capsules " + run.kinds + "\n";
      if (run.Re > 0.)
        text += "  Re   = " + number("%-10.6g", run.Re) + (run.has_rate ? "rho gamma a^2 / mu: with inertia\n" : "rho kappa_B / (mu^2 a): with inertia\n");
      return text;
    }

    const char *const step_format = "%6s %10s %9s %6s %6s %9s %9s %10s %10s";
  } // namespace

  std::string
  duration_text(const double seconds)
  {
    if (!std::isfinite(seconds) || seconds < 0 || seconds > 1e9)
      return "-";
    const long total = std::lround(seconds);
    char       text[40];
    std::snprintf(text, sizeof(text), "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
    return text;
  }

  Log::Log(const bool active)
    : Log(active, std::cout)
  {}

  Log::Log(const bool active, std::ostream &screen)
    : active(active)
    , screen(screen)
  {}

  void
  Log::open(const std::string &file_name)
  {
    if (!active)
      return;
    errno = 0;
    file.open(file_name);
    if (!(file << before_open << std::flush))
      throw OutputError(cannot_write(file_name, errno));
    before_open.clear();
    name = file_name;
  }

  void
  Log::reopen(const std::string &file_name, const std::streamoff size)
  {
    if (!active)
      return;
    cut_and_open(file, file_name, size);
    if (!(file << before_open << std::flush))
      throw OutputError(cannot_write(file_name, errno));
    before_open.clear();
    name = file_name;
  }

  std::streamoff
  Log::written()
  {
    return file.is_open() ? std::streamoff(file.tellp()) : std::streamoff(0);
  }

  void
  Log::header(const RunDescription &run)
  {
    std::string text = program_version() + "\n" + library_versions() + "\n" + std::to_string(run.n_ranks) + (run.n_ranks == 1 ? " rank, " : " ranks, ") +
      run.parameter_file + ", " + now() + "\n\n" + scales_text(run);
    if (!run.included.empty())
      text += "\nComputed with:\n";
    for (const std::string &item : run.included)
      text += "  " + item + "\n";
    if (!run.left_out.empty())
      text += "\nLeft out, because the scene does not need it:\n";
    for (const std::string &item : run.left_out)
      text += "  " + item + "\n";
    line(text);
  }

  void
  Log::line(const std::string &text)
  {
    if (!active)
      return;
    screen << text << std::endl;
    if (name.empty())
      before_open += text + "\n";
    errno = 0;
    if (file.is_open() && !(file << text << std::endl))
      {
        screen << cannot_write(name, errno) << "; from here on the log is on the screen only" << std::endl;
        file.close();
      }
  }

  void
  Log::step(const StepLine &step)
  {
    char text[200];
    if (n_steps++ % 20 == 0)
      {
        std::snprintf(text, sizeof(text), step_format, "step", "time", "dt", "newton", "linear", "D_xz", "theta/pi", "vol. error", "remaining");
        line(text);
      }
    std::snprintf(text,
                  sizeof(text),
                  step_format,
                  std::to_string(step.step).c_str(),
                  number("%.4f", step.time).c_str(),
                  number("%.2e", step.dt).c_str(),
                  std::to_string(step.newton).c_str(),
                  std::to_string(step.linear).c_str(),
                  number("%.5f", step.D).c_str(),
                  number("%.5f", step.theta_over_pi).c_str(),
                  number("%.1e", step.volume_error).c_str(),
                  duration_text(step.remaining_seconds).c_str());
    line(text);
  }

  void
  Log::timings(const Timings &timings)
  {
    line("\nWall time of the first rank\n" + timings.table());
  }
} // namespace tanktread
