// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: tests of names, parameter files and the command line.

#include <tanktread/base/command_line.h>
#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/nearest_name.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/base/parameter_table.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include <array>
#include <limits>

using namespace tanktread;

namespace
{
  enum class Law
  {
    neo_hookean,
    skalak
  };

  /** Parameters of every kind that the program uses. */
  struct Sample
  {
    double                number    = 0.05;
    double                modulus   = 1.;
    unsigned int          level     = 3;
    unsigned int          points    = 3;
    Law                   law       = Law::neo_hookean;
    std::array<double, 3> axes      = {{2., 2., 1.}};
    std::string           directory = "output";

    dealii::ParameterHandler prm;

    Sample()
    {
      using namespace dealii::Patterns;
      prm.enter_subsection("Scene");
      prm.add_parameter("Shear number", number, "Some\n  number.", Double(std::numeric_limits<double>::min()));
      prm.add_parameter("Modulus", modulus, "A|B", Double(0.));
      prm.leave_subsection();
      prm.enter_subsection("Shell mesh");
      prm.add_parameter("Level", level, "", Integer(0, 6));
      prm.add_parameter("Quadrature", points, "", Selection("1|3|6|7|12"));
      prm.enter_subsection("Inner");
      add_enum_parameter(prm, "Law", law, {{"neo-Hookean", Law::neo_hookean}, {"Skalak", Law::skalak}}, "");
      prm.add_parameter("Axes", axes, "", List(Double(0.), 3, 3));
      prm.leave_subsection();
      prm.leave_subsection();
      prm.enter_subsection("Output");
      prm.add_parameter("Directory", directory, "", DirectoryName());
      prm.leave_subsection();
    }

    /** Message of the error that reading `text` ends with; empty without an error. */
    std::string
    error_of(const std::string &text, const std::vector<std::string> &overrides = {})
    {
      try
        {
          read_parameter_text(prm, text, "x.prm", overrides);
        }
      catch (const InputError &error)
        {
          return error.what();
        }
      return "";
    }
  };

  std::string
  command_line_error(const std::vector<std::string> &words)
  {
    try
      {
        parse_command_line(words);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace

// == Names ==

TEST(NearestName, DistanceCountsEdits)
{
  EXPECT_EQ(edit_distance("modulus", "modulus"), 0u);
  EXPECT_EQ(edit_distance("modulus", "Modulus"), 0u);
  EXPECT_EQ(edit_distance("modlus", "modulus"), 1u);
  EXPECT_EQ(edit_distance("moduluss", "modulus"), 1u);
  EXPECT_EQ(edit_distance("mudolus", "modulus"), 2u);
  EXPECT_EQ(edit_distance("omdulus", "modulus"), 1u); // neighbours exchanged
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(NearestName, FarNamesAreNotSuggested)
{
  EXPECT_EQ(nearest_name("Shear numbr", {"End time", "Shear number"}), "Shear number");
  EXPECT_EQ(nearest_name("Temperature", {"End time", "Shear number"}), "");
  EXPECT_EQ(nearest_name("ab", {"cd"}), "");
  EXPECT_EQ(did_you_mean("--valdate", {"--validate"}), "; did you mean \"--validate\"?");
  EXPECT_EQ(did_you_mean("Temperature", {"End time"}), "");
}

// == Reading parameter files ==

TEST(ParameterFile, ReadsValuesAndRemembersWhere)
{
  Sample                sample;
  const ParameterSource source = read_parameter_text(sample.prm,
                                                     "# a comment\n"
                                                     "subsection Scene\n"
                                                     "  set   Shear   number =  0.25   # why\n"
                                                     "end\n"
                                                     "subsection Shell mesh\r\n"
                                                     "  set Quadrature = 12\r\n"
                                                     "  subsection Inner\n"
                                                     "    set Law = Skalak\n"
                                                     "    set Axes = 1, \\\n"
                                                     "      2, 3\n"
                                                     "  end\n"
                                                     "  set Level = 4\n"
                                                     "end",
                                                     "dir/x.prm",
                                                     {"Output/Directory = a=b", "Shell mesh/Inner/Axes=3,2,1"});
  EXPECT_EQ(sample.number, 0.25);
  EXPECT_EQ(sample.modulus, 1.);
  EXPECT_EQ(sample.level, 4u);
  EXPECT_EQ(sample.points, 12u);
  EXPECT_EQ(sample.law, Law::skalak);
  EXPECT_EQ(sample.axes, (std::array<double, 3>{{3., 2., 1.}}));
  EXPECT_EQ(sample.directory, "a=b");
  EXPECT_EQ(source.where("Scene/Shear number"), "dir/x.prm:3");
  EXPECT_EQ(source.where("Shell mesh/Level"), "dir/x.prm:12");
  EXPECT_EQ(source.where("Shell mesh/Inner/Law"), "dir/x.prm:8");
  EXPECT_EQ(source.where("Shell mesh/Inner/Axes"), "--set \"Shell mesh/Inner/Axes=3,2,1\"");
  EXPECT_EQ(source.where("Scene/Modulus"), "default");
  EXPECT_FALSE(source.is_set("Scene/Modulus"));
  EXPECT_EQ(source.locate("Scene/Shear number is odd"), "dir/x.prm:3: Scene/Shear number is odd");
  EXPECT_EQ(source.locate("Scene/Modulus is odd"), "Scene/Modulus is odd");
}

TEST(ParameterFile, NamesFileLineAndWhatIsAllowed)
{
  const auto in_scene = [](const std::string &line) { return Sample().error_of("subsection Scene\n" + line + "\nend\n"); };
  EXPECT_EQ(in_scene("set Modulus = -2"), "x.prm:2: Scene/Modulus = -2; allowed: a number >= 0");
  EXPECT_EQ(in_scene("set Shear number = 0"), "x.prm:2: Scene/Shear number = 0; allowed: a number > 0");
  EXPECT_EQ(in_scene("set Shear number = abc"), "x.prm:2: Scene/Shear number = abc; allowed: a number > 0");
  EXPECT_EQ(in_scene("set Shear number = nan"), "x.prm:2: Scene/Shear number = nan; allowed: a number > 0");
  EXPECT_EQ(in_scene("set Shear number = 1e999"), "x.prm:2: Scene/Shear number = 1e999; allowed: a number > 0");
  EXPECT_EQ(in_scene("set Shear number ="), "x.prm:2: Scene/Shear number = (empty); allowed: a number > 0");
  EXPECT_EQ(in_scene("set Shear numbr = 1"), "x.prm:2: unknown parameter \"Shear numbr\" in section \"Scene\"; did you mean \"Shear number\"?");
  EXPECT_EQ(in_scene("set Colour = 1"), "x.prm:2: unknown parameter \"Colour\" in section \"Scene\"; allowed: Shear number, Modulus");
  EXPECT_EQ(in_scene("set Level = 1"), "x.prm:2: unknown parameter \"Level\" in section \"Scene\"; it belongs to section \"Shell mesh\"");
  EXPECT_EQ(in_scene("Modulus = 1"), "x.prm:2: cannot read \"Modulus = 1\"; allowed: subsection NAME, set NAME = VALUE, end, # comment");
  EXPECT_EQ(in_scene("set Modulus 1"), "x.prm:2: cannot read \"set Modulus 1\"; allowed: subsection NAME, set NAME = VALUE, end, # comment");
  EXPECT_EQ(in_scene("set Modulus = 1\nset Modulus = 2"), "x.prm:3: \"Modulus\" is set twice; it was set first at x.prm:2");
  EXPECT_EQ(in_scene("end\nend\nsubsection Scene"), "x.prm:3: \"end\" closes no section");
}

TEST(ParameterFile, NamesWrongWordsAndSections)
{
  const auto error = [](const std::string &text) { return Sample().error_of(text); };
  EXPECT_EQ(error("subsection Shell mesh\nsubsection Inner\nset Law = Neo\nend\nend"),
            "x.prm:3: Shell mesh/Inner/Law = Neo; allowed: one of neo-Hookean, Skalak");
  EXPECT_EQ(error("subsection Shell mesh\nset Quadrature = 4\nset Level = 7\nend"),
            "x.prm:2: Shell mesh/Quadrature = 4; allowed: one of 1, 3, 6, 7, 12\nx.prm:3: Shell mesh/Level = 7; allowed: a whole number from 0 to 6");
  EXPECT_EQ(error("subsection Scen\nset Modulus = 2\nend"), "x.prm:1: unknown section \"Scen\"; did you mean \"Scene\"?");
  EXPECT_EQ(error("subsection Fluid\nsubsection Scene\nset Modulus = -2\nend\nend"), "x.prm:1: unknown section \"Fluid\"; allowed: Scene, Shell mesh, Output");
  EXPECT_EQ(error("subsection Shell mesh\nsubsection Iner\nend\nend"), "x.prm:2: unknown section \"Iner\" in section \"Shell mesh\"; did you mean \"Inner\"?");
  EXPECT_EQ(error("\nsubsection Scene\n"), "x.prm:2: section \"Scene\" has no \"end\"");
  EXPECT_EQ(error("set Modulus = 1"), "x.prm:1: unknown parameter \"Modulus\" outside of all sections; it belongs to section \"Scene\"");
}

TEST(ParameterFile, NamesOverrides)
{
  const auto error = [](const std::string &setting) { return Sample().error_of("", {setting}); };
  EXPECT_EQ(error("Scene/Modulus=-1"), "--set \"Scene/Modulus=-1\": Scene/Modulus = -1; allowed: a number >= 0");
  EXPECT_EQ(error("Scene/Modlus=1"), "--set \"Scene/Modlus=1\": unknown parameter \"Modlus\" in section \"Scene\"; did you mean \"Modulus\"?");
  EXPECT_EQ(error("Sene/Modulus=1"), "--set \"Sene/Modulus=1\": unknown section \"Sene\"; did you mean \"Scene\"?");
  EXPECT_EQ(error("Modulus=1"), "--set \"Modulus=1\": cannot be read; allowed: --set \"Section/Parameter=value\"");
  EXPECT_EQ(error("Scene/Modulus"), "--set \"Scene/Modulus\": cannot be read; allowed: --set \"Section/Parameter=value\"");
  EXPECT_EQ(error("Scene/Modulus=1"), "");
}

TEST(ParameterFile, ReportsAllErrorsTogether)
{
  const std::string message = Sample().error_of("subsection Scene\nset Modulus = -1\nset Shear numbr = 1\nend\nend\n", {"Shell mesh/Level=x"});
  EXPECT_EQ(count(message, "\n"), 3u) << message;
  for (const char *const place : {"x.prm:2:", "x.prm:3:", "x.prm:5:", "--set"})
    EXPECT_NE(message.find(place), std::string::npos) << message;
}

TEST(ParameterFile, AnEmptyFileIsOne)
{
  const std::string name = "/tmp/tanktread_base_tests_" + std::to_string(getpid()) + ".prm";
  for (const char *const text : {"", "\n", "# nothing"})
    {
      std::ofstream(name) << text;
      Sample sample;
      EXPECT_NO_THROW(read_parameter_file(sample.prm, name)) << text;
    }
  std::remove(name.c_str());
}

TEST(ParameterFile, MissingFileIsNamed)
{
  for (const char *const name : {"/no/such/file.prm", "/tmp"})
    try
      {
        Sample sample;
        read_parameter_file(sample.prm, name);
        ADD_FAILURE() << name;
      }
    catch (const InputError &error)
      {
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      }
}

// == Printing parameters ==

TEST(ParameterTable, PatternsInWords)
{
  EXPECT_EQ(pattern_in_words("[Double -1...1 (inclusive)]"), "a number from -1 to 1");
  EXPECT_EQ(pattern_in_words("[Double -MAX_DOUBLE...MAX_DOUBLE (inclusive)]"), "a number");
  EXPECT_EQ(pattern_in_words("[Double -MAX_DOUBLE...2 (inclusive)]"), "a number <= 2");
  EXPECT_EQ(pattern_in_words("[Double 2.22507e-308...2 (inclusive)]"), "a number > 0 and <= 2");
  EXPECT_EQ(pattern_in_words("[Integer]"), "a whole number");
  EXPECT_EQ(pattern_in_words("[Bool]"), "true or false");
  EXPECT_EQ(pattern_in_words("[FileName (Type: input)]"), "name of a file");
  EXPECT_EQ(pattern_in_words("[Selection a|b c ]"), "one of a, b c");
  EXPECT_EQ(pattern_in_words("[List of <[Double 0...MAX_DOUBLE (inclusive)]> of length 3...3 (inclusive)]"),
            "3 entries separated by commas, each a number >= 0");
  EXPECT_EQ(pattern_in_words("[List of <[Bool]> of length 1...3 (inclusive)]"), "1 to 3 entries separated by commas, each true or false");
  EXPECT_EQ(pattern_in_words("[List of <[List of <[Integer]> of length 3...3 (inclusive)]> of length 1...1000000 (inclusive) separated by <;>]"),
            "entries separated by semicolons, each 3 entries separated by commas, each a whole number");
  EXPECT_EQ(pattern_in_words("[Else]"), "[Else]");
}

TEST(ParameterTable, PrintedFileReadsBackTheSame)
{
  Sample first, second;
  read_parameter_text(first.prm, "", "x.prm", {"Scene/Shear number=0.125", "Shell mesh/Inner/Law=Skalak", "Shell mesh/Level=5"});
  const std::string printed = parameters_as_prm(first.prm);
  EXPECT_NE(printed.find("  # Some number.\n  # Allowed: a number > 0. Default: 0.05.\n  set Shear number = 0.125\n"), std::string::npos) << printed;
  read_parameter_text(second.prm, printed, "printed.prm");
  EXPECT_EQ(second.number, 0.125);
  EXPECT_EQ(second.law, Law::skalak);
  EXPECT_EQ(second.level, 5u);
  EXPECT_EQ(second.axes, first.axes);
  EXPECT_EQ(parameters_as_prm(second.prm), printed);
}

TEST(ParameterTable, MarkdownHasOneRowAParameter)
{
  Sample            sample;
  const std::string text = parameters_as_markdown(sample.prm);
  EXPECT_EQ(count(text, "## "), 4u) << text;
  EXPECT_EQ(count(text, "\n| Parameter |"), 4u) << text;
  EXPECT_NE(text.find("| Modulus | 1 | a number >= 0 | A\\|B |\n"), std::string::npos) << text;
}

// == Command line ==

TEST(CommandLine, ReadsOptionsInAnyOrder)
{
  using Action          = CommandLine::Action;
  const CommandLine run = parse_command_line({"--set", "A/b=1", "x.prm", "--set", "A/c=-2"});
  EXPECT_EQ(run.action, Action::run);
  EXPECT_EQ(run.file, "x.prm");
  EXPECT_EQ(run.overrides, (std::vector<std::string>{"A/b=1", "A/c=-2"}));
  EXPECT_EQ(parse_command_line({"--validate", "x.prm"}).action, Action::validate);
  EXPECT_EQ(parse_command_line({"--print-parameters"}).action, Action::print_prm);
  EXPECT_EQ(parse_command_line({"--print-parameters", "prm"}).action, Action::print_prm);
  EXPECT_EQ(parse_command_line({"--print-parameters", "markdown"}).action, Action::print_markdown);
  EXPECT_EQ(parse_command_line({"--version"}).action, Action::version);
  EXPECT_EQ(parse_command_line({"--help"}).action, Action::help);
}

TEST(CommandLine, NamesWhatIsWrong)
{
  EXPECT_NE(command_line_error({"--valdate", "x.prm"}).find("unknown option \"--valdate\"; did you mean \"--validate\"?"), std::string::npos);
  EXPECT_NE(command_line_error({"--set"}).find("--set needs a value"), std::string::npos);
  EXPECT_NE(command_line_error({"--set", "--validate", "x.prm"}).find("--set needs a value"), std::string::npos);
  EXPECT_NE(command_line_error({"--resume", "--validate", "x.prm"}).find("--resume is for a run"), std::string::npos);
  EXPECT_NE(command_line_error({"a.prm", "b.prm"}).find("more than one"), std::string::npos);
  EXPECT_NE(command_line_error({}).find("no parameter file"), std::string::npos);
  EXPECT_NE(command_line_error({"--validate"}).find("no parameter file"), std::string::npos);
  EXPECT_NE(command_line_error({"--print-parameters", "html"}).find("html"), std::string::npos);
  for (const char *const option : {"--set", "--validate", "--print-parameters", "--version", "--help"})
    EXPECT_NE(help_text().find(option), std::string::npos);
}
