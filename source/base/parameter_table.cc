// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the list of all declared parameters, and how it is printed.

#include <tanktread/base/parameter_table.h>

#define BOOST_BIND_GLOBAL_PLACEHOLDERS // boost/bind.hpp prints a note otherwise
#include <deal.II/base/parameter_handler.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <regex>
#include <sstream>

namespace tanktread
{
  namespace
  {
    using Tree = boost::property_tree::ptree;

    std::string
    on_one_line(const std::string &text)
    {
      return std::regex_replace(text, std::regex("\\s+"), " ");
    }

    void
    collect(const Tree &tree, const std::string &section, std::vector<ParameterInfo> &table)
    {
      for (const auto &[name, child] : tree)
        if (child.find("pattern_description") == child.not_found())
          collect(child, section.empty() ? name : section + "/" + name, table);
        else
          table.push_back({section,
                           name,
                           child.get<std::string>("value"),
                           child.get<std::string>("default_value"),
                           on_one_line(child.get<std::string>("documentation")),
                           pattern_in_words(child.get<std::string>("pattern_description"))});
    }

    std::string
    range_in_words(const std::string &kind, const std::string &lower, const std::string &upper)
    {
      const bool        below_free = lower.empty() || lower.find("MAX") != std::string::npos;
      const bool        above_free = upper.empty() || upper.find("MAX") != std::string::npos;
      const double      bound      = std::strtod(lower.c_str(), nullptr);
      const bool        positive   = !below_free && bound > 0 && bound <= 2 * std::numeric_limits<double>::min();
      const std::string at_least   = positive ? "> 0" : ">= " + lower;
      if (below_free && above_free)
        return kind;
      if (above_free)
        return kind + " " + at_least;
      if (below_free)
        return kind + " <= " + upper;
      return positive ? kind + " > 0 and <= " + upper : kind + " from " + lower + " to " + upper;
    }

    std::string
    selection_in_words(const std::string &alternatives)
    {
      std::istringstream stream(alternatives);
      std::string        words, word;
      while (std::getline(stream, word, '|'))
        words += (words.empty() ? "one of " : ", ") + std::regex_replace(word, std::regex("^ +| +$"), "");
      return words;
    }

    /** `text` as comment lines of at most 100 characters, each starting with `start`. */
    std::string
    as_comment(const std::string &start, const std::string &text)
    {
      std::istringstream stream(text);
      std::string        lines, line, word;
      while (stream >> word)
        {
          if (!line.empty() && start.size() + line.size() + word.size() + 1 > 100)
            {
              lines += start + line + "\n";
              line.clear();
            }
          line += (line.empty() ? "" : " ") + word;
        }
      return line.empty() ? lines : lines + start + line + "\n";
    }

    std::vector<std::string>
    split_section(const std::string &section)
    {
      std::vector<std::string> names;
      std::istringstream       stream(section);
      std::string              name;
      while (std::getline(stream, name, '/'))
        names.push_back(name);
      return names;
    }

    /** The `end` and `subsection` lines that lead from section `from` to section `to`. */
    std::string
    change_section(const std::vector<std::string> &from, const std::vector<std::string> &to)
    {
      std::size_t common = 0;
      while (common < std::min(from.size(), to.size()) && from[common] == to[common])
        ++common;
      std::string lines;
      for (std::size_t i = from.size(); i > common; --i)
        lines += std::string(2 * (i - 1), ' ') + "end\n" + (i == 1 ? "\n" : "");
      for (std::size_t i = common; i < to.size(); ++i)
        lines += std::string(2 * i, ' ') + "subsection " + to[i] + "\n";
      return lines;
    }

    std::string
    or_empty(const std::string &value)
    {
      return value.empty() ? "(empty)" : value;
    }

    /** Text that may stand in a cell of a Markdown table. */
    std::string
    in_table(const std::string &text)
    {
      return std::regex_replace(text, std::regex("\\|"), "\\|");
    }

    /** Numbers of entries with many digits stand for any number. */
    std::string
    count_in_words(const std::string &low, const std::string &high)
    {
      if (low == high)
        return low + " entries";
      return high.size() > 2 ? "entries" : low + " to " + high + " entries";
    }

    std::string
    separator_in_words(const std::string &separator)
    {
      return separator.empty() || separator == "," ? "commas" : separator == ";" ? "semicolons" : "'" + separator + "'";
    }
  } // namespace

  std::vector<ParameterInfo>
  parameter_table(const dealii::ParameterHandler &prm)
  {
    std::stringstream json;
    prm.print_parameters(json, dealii::ParameterHandler::JSON | dealii::ParameterHandler::KeepDeclarationOrder);
    Tree tree;
    boost::property_tree::read_json(json, tree);
    std::vector<ParameterInfo> table;
    collect(tree, "", table);
    return table;
  }

  std::string
  pattern_in_words(const std::string &description)
  {
    const std::string number = "([^ \\]]+?)\\.\\.\\.([^ \\]]+)";
    std::smatch       found;
    if (std::regex_match(description, found, std::regex("\\[Double(?: " + number + " \\(inclusive\\))?\\]")))
      return range_in_words("a number", found[1], found[2]);
    if (std::regex_match(description, found, std::regex("\\[Integer(?: range " + number + " \\(inclusive\\))?\\]")))
      return range_in_words("a whole number", found[1], found[2]);
    if (std::regex_match(description, found, std::regex("\\[Selection (.*)\\]")))
      return selection_in_words(found[1]);
    if (std::regex_match(description, found, std::regex("\\[List of <(.*)> of length (\\d+)\\.\\.\\.(\\d+) \\(inclusive\\)(?: separated by <(.+)>)?\\]")))
      return count_in_words(found[2], found[3]) + " separated by " + separator_in_words(found[4]) + ", each " + pattern_in_words(found[1]);
    if (description == "[Bool]")
      return "true or false";
    if (description == "[Anything]")
      return "any text";
    if (description == "[DirectoryName]")
      return "name of a folder";
    if (description.rfind("[FileName", 0) == 0)
      return "name of a file";
    return description;
  }

  std::string
  parameters_as_prm(const dealii::ParameterHandler &prm)
  {
    std::string              text;
    std::vector<std::string> section;
    for (const ParameterInfo &parameter : parameter_table(prm))
      {
        const std::vector<std::string> next = split_section(parameter.section);
        text += change_section(section, next);
        text += next == section ? "\n" : "";
        section = next;

        const std::string indent(2 * section.size(), ' ');
        text += as_comment(indent + "# ", parameter.documentation);
        text += as_comment(indent + "# ", "Allowed: " + parameter.allowed + ". Default: " + or_empty(parameter.default_value) + ".");
        text += indent + "set " + parameter.name + " =" + (parameter.value.empty() ? "" : " " + parameter.value) + "\n";
      }
    return text + change_section(section, {});
  }

  std::string
  parameters_as_markdown(const dealii::ParameterHandler &prm)
  {
    std::string text, section;
    for (const ParameterInfo &parameter : parameter_table(prm))
      {
        if (parameter.section != section)
          text += (text.empty() ? "" : "\n") + ("## " + parameter.section) + "\n\n| Parameter | Default | Allowed | Meaning |\n|---|---|---|---|\n";
        section = parameter.section;
        text += "| " + parameter.name + " | " + in_table(or_empty(parameter.default_value)) + " | " + in_table(parameter.allowed) + " | " +
          in_table(parameter.documentation) + " |\n";
      }
    return text;
  }
} // namespace tanktread
