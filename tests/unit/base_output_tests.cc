// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of the output folder, log, timings and tables.

#include <tanktread/base/csv_writer.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/log.h>
#include <tanktread/base/output_file.h>
#include <tanktread/base/output_folder.h>
#include <tanktread/base/timings.h>
#include <tanktread/base/version.h>

#include <gtest/gtest.h>

#include <sys/resource.h>

#include "temporary_folder.h"
#include <cmath>
#include <csignal>
#include <functional>
#include <thread>

using namespace tanktread;

namespace
{
  std::string
  output_folder_error(const fs::path &folder)
  {
    try
      {
        prepare_output_folder(folder.string());
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace

// == Output folder ==

TEST(OutputFolder, IsMadeWithItsParents)
{
  const TemporaryFolder temporary;
  EXPECT_EQ(prepare_output_folder((temporary.path / "a/b/c/").string()), "");
  EXPECT_TRUE(fs::is_directory(temporary.path / "a/b/c"));
  EXPECT_TRUE(fs::is_empty(temporary.path / "a/b/c"));
}

TEST(OutputFolder, CheckingChangesNothing)
{
  const TemporaryFolder temporary;
  check_output_folder((temporary.path / "a/b").string());
  EXPECT_TRUE(fs::is_empty(temporary.path));
}

TEST(OutputFolder, FormerRunIsMovedAside)
{
  const TemporaryFolder temporary;
  const fs::path        folder = temporary.path / "run";
  for (const char *const run : {"1", "2", "3"})
    {
      const std::string aside = prepare_output_folder(folder.string() + "/");
      EXPECT_EQ(aside, run[0] == '1' ? "" : folder.string() + ".previous");
      EXPECT_TRUE(fs::is_empty(folder));
      write(folder / "history.csv", run);
    }
  EXPECT_EQ(contents(folder.string() + ".previous/history.csv"), "2");
  // One of several capsules has no history.csv.
  fs::remove(folder / "history.csv");
  write(folder / "history_1.csv", "4");
  EXPECT_EQ(prepare_output_folder(folder.string()), folder.string() + ".previous");
  EXPECT_EQ(contents(folder.string() + ".previous/history_1.csv"), "4");
}

TEST(OutputFolder, FolderThatIsNoRunStays)
{
  const TemporaryFolder temporary;
  const fs::path        folder = temporary.path / "run";
  fs::create_directories(folder);
  write(folder / "notes.txt", "mine");
  EXPECT_EQ(prepare_output_folder(folder.string()), "");
  EXPECT_EQ(contents(folder / "notes.txt"), "mine");

  write(folder / "history.csv", "1");
  fs::create_directories(folder.string() + ".previous");
  write(folder.string() + ".previous/thesis.tex", "mine");
  EXPECT_NE(output_folder_error(folder).find("is no run"), std::string::npos);
  EXPECT_EQ(contents(folder.string() + ".previous/thesis.tex"), "mine");
  EXPECT_EQ(contents(folder / "history.csv"), "1");
}

TEST(OutputFolder, RunsInsideOfFormerRunsAreNotRemoved)
{
  const TemporaryFolder temporary;
  const fs::path        folder = temporary.path / "run";
  fs::create_directories(folder / "nested");
  write(folder / "history.csv", "1");
  write(folder / "nested/history.csv", "2");
  EXPECT_EQ(prepare_output_folder(folder.string()), folder.string() + ".previous");
  write(folder / "history.csv", "3");
  EXPECT_NE(output_folder_error(folder).find("more than one"), std::string::npos);
  EXPECT_EQ(contents(folder.string() + ".previous/nested/history.csv"), "2");
}

TEST(OutputFolder, NamesFolderAndReason)
{
  const TemporaryFolder temporary;
  write(temporary.path / "file", "");
  EXPECT_NE(output_folder_error(temporary.path / "file").find("file\" is not a folder"), std::string::npos);
  EXPECT_NE(output_folder_error(temporary.path / "file/a/b").find("file\" is not a folder"), std::string::npos);
  EXPECT_NE(output_folder_error("/proc/tanktread/a").find("/proc/tanktread/a"), std::string::npos);
  EXPECT_NE(output_folder_error("").find("is empty"), std::string::npos);
}

// == Log, timings, tables ==

TEST(Log, HeaderNamesVersionsScalesAndWhatIsLeftOut)
{
  std::ostringstream screen;
  Log                log(true, screen);
  RunDescription     run;
  run.parameter_file = "a.prm";
  run.n_ranks        = 3;
  run.G              = 0.05;
  run.khat           = 0.01;
  run.flow           = "planar extension";
  run.box            = "12 x 12 periodic x 12";
  run.left_out       = {"inertia (Re = 0)"};
  log.header(run);
  for (const std::string &part : {program_version(), library_versions(), std::string("3 ranks"), std::string("a.prm"), std::string("inertia (Re = 0)")})
    EXPECT_NE(screen.str().find(part), std::string::npos) << part;
  EXPECT_NE(screen.str().find("Ca   = 0.15 "), std::string::npos) << screen.str();
  EXPECT_NE(screen.str().find("flow = planar extension\n"), std::string::npos) << screen.str();
  EXPECT_NE(screen.str().find("box  = 12 x 12 periodic x 12\n"), std::string::npos) << screen.str();
  EXPECT_EQ(screen.str().find("capsules"), std::string::npos) << screen.str();
  EXPECT_EQ(screen.str().find("with inertia"), std::string::npos) << screen.str();
  run.Re = 0.5;
  log.header(run);
  EXPECT_NE(screen.str().find("Re   = 0.5       rho gamma a^2 / mu: with inertia"), std::string::npos) << screen.str();
  run.n_capsules = 3;
  run.has_rate   = false;
  log.header(run);
  EXPECT_NE(screen.str().find("N    = 3 capsules"), std::string::npos) << screen.str();
  EXPECT_NE(screen.str().find("time in mu a^3 / kappa_B.\n"), std::string::npos) << screen.str();
  EXPECT_NE(screen.str().find("Re   = 0.5       rho kappa_B / (mu^2 a): with inertia"), std::string::npos) << screen.str();
}

TEST(Log, ColumnNamesEveryTwentySteps)
{
  std::ostringstream screen;
  Log                log(true, screen);
  StepLine           step;
  for (step.step = 1; step.step <= 41; ++step.step)
    log.step(step);
  EXPECT_EQ(count(screen.str(), "theta/pi"), 3u);
  EXPECT_EQ(count(screen.str(), "\n"), 44u);
}

TEST(Log, NumbersOfAStepAreWritten)
{
  std::ostringstream screen;
  Log                log(true, screen);
  log.step({7, 1.25, 0.0125, 3, 84, 0.24513, std::nan(""), 1.2e-9, 3723.});
  for (const char *const word : {"     7 ", "1.2500", "1.25e-02", " 3 ", " 84 ", "0.24513", " - ", "1.2e-09", "1:02:03"})
    EXPECT_NE(screen.str().find(word), std::string::npos) << word << screen.str();
  EXPECT_EQ(duration_text(-1), "-");
}

TEST(Log, FileHasEverythingAndOtherRanksNothing)
{
  const TemporaryFolder temporary;
  const std::string     name = (temporary.path / "log.txt").string();
  std::ostringstream    screen;
  {
    Log log(true, screen), silent(false, screen);
    log.line("before");
    silent.open((temporary.path / "silent.txt").string());
    silent.line("no");
    log.open(name);
    log.line("after");
    EXPECT_THROW(Log(true, screen).open("/proc/no/log.txt"), OutputError);
  }
  EXPECT_EQ(screen.str(), "before\nafter\n");
  EXPECT_EQ(contents(name), "before\nafter\n");
  EXPECT_FALSE(fs::exists(temporary.path / "silent.txt"));
}

TEST(Timings, AddUpTimeAndCalls)
{
  Timings timings;
  for (int i = 0; i < 3; ++i)
    {
      const Timings::Scope outer(timings, "outer");
      const Timings::Scope inner(timings, "inner");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  ASSERT_EQ(timings.parts().size(), 2u);
  EXPECT_EQ(timings.parts()[0].name, "outer");
  EXPECT_EQ(timings.parts()[0].calls, 3u);
  EXPECT_GE(timings.parts()[0].seconds, 0.015);
  EXPECT_GE(timings.parts()[0].seconds, timings.parts()[1].seconds);
  EXPECT_GE(timings.elapsed(), timings.parts()[0].seconds);
  EXPECT_EQ(count(timings.table(), "\n"), 4u);
}

TEST(Timings, PiecesAndWhatTheyLeaveOfTheirPart)
{
  Timings timings;
  {
    const Timings::Scope before(timings, "before");
    const Timings::Scope outer(timings, "outer");
    for (const char *name : {"- one", "- two"})
      {
        const Timings::Scope piece(&timings, name);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    const Timings::Scope nothing(nullptr, "- one");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  {
    const Timings::Scope after(timings, "after");
  }
  ASSERT_EQ(timings.parts().size(), 5u);
  EXPECT_EQ(timings.parts()[2].calls, 1u);
  EXPECT_DOUBLE_EQ(timings.rest("outer"), timings.seconds("outer") - timings.seconds("- one") - timings.seconds("- two"));
  EXPECT_GE(timings.rest("outer"), 0.005);
  EXPECT_DOUBLE_EQ(timings.rest("before"), timings.seconds("before"));
  EXPECT_EQ(timings.seconds("unknown"), 0.);
  const std::string table = timings.table();
  EXPECT_LT(table.find("  - two"), table.find("  - rest"));
  EXPECT_LT(table.find("  - rest"), table.find("after"));
  EXPECT_EQ(count(table, "- rest"), 1u);
}

TEST(CsvWriter, RowsAreOnDiskAtOnceWithTenDigits)
{
  const TemporaryFolder temporary;
  const fs::path        name = temporary.path / "history.csv";
  CsvWriter             table(name.string(), {"time", "D_xz", "newton_iterations"});
  EXPECT_EQ(contents(name), "time,D_xz,newton_iterations\n");
  table.row({0.1, 1. / 3., 4});
  EXPECT_EQ(contents(name), "time,D_xz,newton_iterations\n0.1,0.3333333333,4\n");
  EXPECT_THROW(table.row({1., 2.}), std::logic_error);
}

TEST(CsvWriter, FailsLoudly)
{
  const TemporaryFolder temporary;
  EXPECT_THROW(CsvWriter((temporary.path / "no/history.csv").string(), {"time"}), OutputError);
  CsvWriter silent((temporary.path / "silent.csv").string(), {"time"}, false);
  silent.row({1.});
  EXPECT_FALSE(fs::exists(temporary.path / "silent.csv"));
}

// == Full disks ==

namespace
{
  /** While it lives no file of this process grows beyond `n_bytes`, as on a disk that is full. */
  class LimitedFiles
  {
  public:
    explicit LimitedFiles(const rlim_t n_bytes)
      : handler(std::signal(SIGXFSZ, SIG_IGN))
    {
      getrlimit(RLIMIT_FSIZE, &before);
      const rlimit limited = {n_bytes, before.rlim_max};
      setrlimit(RLIMIT_FSIZE, &limited);
    }

    ~LimitedFiles()
    {
      setrlimit(RLIMIT_FSIZE, &before);
      std::signal(SIGXFSZ, handler);
    }

  private:
    void (*handler)(int);
    rlimit before;
  };

  std::string
  output_error(const std::function<void()> &work)
  {
    try
      {
        work();
      }
    catch (const OutputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace

TEST(FullDisk, ATableKeepsItsWholeRows)
{
  const TemporaryFolder temporary;
  const fs::path        name = temporary.path / "history.csv";
  CsvWriter             table(name.string(), {"time", "D_xz"});
  const LimitedFiles    limit(40);
  table.row({0.1, 1. / 3.});
  const std::string message = output_error([&] { table.row({0.2, 2. / 3.}); });
  EXPECT_EQ(message, "cannot write \"" + name.string() + "\": File too large");
  EXPECT_EQ(contents(name), "time,D_xz\n0.1,0.3333333333\n");
}

TEST(FullDisk, AFileThatIsReplacedStays)
{
  const TemporaryFolder temporary;
  const fs::path        name = temporary.path / "series.pvd";
  replace_file(name.string(), "old");
  {
    const LimitedFiles limit(40);
    EXPECT_EQ(output_error([&] { replace_file(name.string(), std::string(100000, 'x')); }), "cannot write \"" + name.string() + "\": File too large");
  }
  EXPECT_EQ(contents(name), "old");
  EXPECT_FALSE(fs::exists(name.string() + ".part"));
  replace_file(name.string(), "new");
  EXPECT_EQ(contents(name), "new");
}

TEST(FullDisk, TheLogGoesOnOnTheScreen)
{
  const TemporaryFolder temporary;
  const std::string     name = (temporary.path / "log.txt").string();
  std::ostringstream    screen;
  Log                   log(true, screen);
  log.open(name);
  log.line("first");
  {
    const LimitedFiles limit(10);
    log.line("second");
    log.line("third");
  }
  EXPECT_EQ(screen.str(), "first\nsecond\ncannot write \"" + name + "\": File too large; from here on the log is on the screen only\nthird\n");
  EXPECT_EQ(contents(name).rfind("first\n", 0), 0u);
}

TEST(FullDisk, TheDeviceThatIsAlwaysFull)
{
  if (!fs::exists("/dev/full"))
    GTEST_SKIP() << "no /dev/full";
  std::ostringstream screen;
  Log                log(true, screen);
  log.line("first");
  const std::string wanted = "cannot write \"/dev/full\": No space left on device";
  EXPECT_EQ(output_error([&] { log.open("/dev/full"); }), wanted);
  EXPECT_EQ(output_error([] { CsvWriter("/dev/full", {"time"}); }), wanted);
}

TEST(Version, NamesProgramAndLibraries)
{
  EXPECT_EQ(program_version().rfind("Tanktread 0.", 0), 0u);
  for (const char *const library : {"deal.II 9.", "Trilinos 1", "p4est 2.", "OpenSubdiv 3.", "Eigen 3."})
    EXPECT_NE(library_versions().find(library), std::string::npos) << library_versions();
}
