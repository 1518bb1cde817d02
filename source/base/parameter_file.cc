// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: reads parameter files, with errors that name file and line.

#include <tanktread/base/exceptions.h>
#include <tanktread/base/nearest_name.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/base/parameter_table.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** `text` without white space at both ends, and with every run of white space inside as one blank. */
    std::string
    squeeze(const std::string &text)
    {
      std::istringstream stream(text);
      std::string        word, result;
      while (stream >> word)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }

    std::string
    quoted(const std::string &text)
    {
      return "\"" + text + "\"";
    }

    std::string
    joined(const std::vector<std::string> &words)
    {
      std::string result;
      for (const std::string &word : words)
        result += (result.empty() ? "" : ", ") + word;
      return result;
    }

    /** The nearest of `known`, or all of them when none is near; to be appended to a message about the unknown `name`. */
    std::string
    suggestion(const std::string &name, const std::vector<std::string> &known)
    {
      const std::string nearest = did_you_mean(name, known);
      return !nearest.empty() || known.empty() ? nearest : "; allowed: " + joined(known);
    }

    struct Line
    {
      std::string  text; // squeezed, without comment
      unsigned int number;
    };

    /** The lines of `text` that say something; a line continued by a backslash has the number of its first part. */
    std::vector<Line>
    lines_of(const std::string &text)
    {
      std::vector<Line>  lines;
      std::istringstream stream(text);
      std::string        part, whole;
      unsigned int       number = 0, first = 1;
      while (std::getline(stream, part))
        {
          ++number;
          if (whole.empty())
            first = number;
          part                 = part.substr(0, part.find('#'));
          const auto last      = part.find_last_not_of(" \t\r");
          const bool continued = last != std::string::npos && part[last] == '\\';
          whole += continued ? part.substr(0, last) : part;
          if (!continued)
            {
              if (!squeeze(whole).empty())
                lines.push_back({squeeze(whole), first});
              whole.clear();
            }
        }
      if (!squeeze(whole).empty())
        lines.push_back({squeeze(whole), first});
      return lines;
    }

    /** Takes settings one by one, puts the good ones into the ParameterHandler and collects a message for each bad one. */
    class Reader
    {
    public:
      explicit Reader(dealii::ParameterHandler &prm)
        : prm(prm)
        , table(parameter_table(prm))
      {}

      void
      read_text(const std::string &text, const std::string &file_name);

      void
      read_override(const std::string &text);

      ParameterSource
      finish() const;

    private:
      struct OpenSection
      {
        std::string  path;
        unsigned int line;
        bool         known;
      };

      void
      error(const std::string &place, const std::string &message)
      {
        errors.push_back(place + ": " + message);
      }

      std::vector<std::string>
      subsections(const std::string &path) const;

      std::vector<std::string>
      parameters(const std::string &section) const;

      void
      open_section(const std::string &name, const std::string &place, const unsigned int line);

      void
      set_in_file(const std::string &setting, const std::string &place);

      void
      set(const std::string &section, const std::string &name, const std::string &value, const std::string &place);

      void
      report_unknown_parameter(const std::string &section, const std::string &name, const std::string &place);

      dealii::ParameterHandler          &prm;
      const std::vector<ParameterInfo>   table;
      std::vector<OpenSection>           open;
      std::map<std::string, std::string> set_in_file_at;
      ParameterSource                    source;
      std::vector<std::string>           errors;
    };

    /** Names of the sections directly below section `path`. */
    std::vector<std::string>
    Reader::subsections(const std::string &path) const
    {
      const std::string        start = path.empty() ? "" : path + "/";
      std::vector<std::string> names;
      for (const ParameterInfo &parameter : table)
        if (parameter.section.size() > start.size() && parameter.section.compare(0, start.size(), start) == 0)
          {
            const std::string name = parameter.section.substr(start.size(), parameter.section.find('/', start.size()) - start.size());
            if (std::find(names.begin(), names.end(), name) == names.end())
              names.push_back(name);
          }
      return names;
    }

    std::vector<std::string>
    Reader::parameters(const std::string &section) const
    {
      std::vector<std::string> names;
      for (const ParameterInfo &parameter : table)
        if (parameter.section == section)
          names.push_back(parameter.name);
      return names;
    }

    void
    Reader::open_section(const std::string &name, const std::string &place, const unsigned int line)
    {
      const bool        parent_known = open.empty() || open.back().known;
      const std::string parent       = open.empty() ? "" : open.back().path;
      const auto        names        = subsections(parent);
      const bool        known        = parent_known && std::find(names.begin(), names.end(), name) != names.end();
      if (parent_known && !known)
        error(place, "unknown section " + quoted(name) + (parent.empty() ? "" : " in section " + quoted(parent)) + suggestion(name, names));
      open.push_back({parent.empty() ? name : parent + "/" + name, line, known});
    }

    void
    Reader::read_text(const std::string &text, const std::string &file_name)
    {
      for (const Line &line : lines_of(text))
        {
          const std::string place = file_name + ":" + std::to_string(line.number);
          const std::string word  = line.text.substr(0, line.text.find(' '));
          const std::string rest  = word.size() < line.text.size() ? line.text.substr(word.size() + 1) : "";
          if (word == "subsection" && !rest.empty())
            open_section(rest, place, line.number);
          else if (word == "set" && rest.find('=') != std::string::npos)
            set_in_file(rest, place);
          else if (line.text == "end" && !open.empty())
            open.pop_back();
          else if (line.text == "end")
            error(place, "\"end\" closes no section");
          else
            error(place, "cannot read " + quoted(line.text) + "; allowed: subsection NAME, set NAME = VALUE, end, # comment");
        }
      for (const OpenSection &section : open)
        error(file_name + ":" + std::to_string(section.line), "section " + quoted(section.path) + " has no \"end\"");
    }

    void
    Reader::set_in_file(const std::string &setting, const std::string &place)
    {
      const std::string name    = squeeze(setting.substr(0, setting.find('=')));
      const std::string value   = squeeze(setting.substr(setting.find('=') + 1));
      const std::string section = open.empty() ? "" : open.back().path;
      if (!open.empty() && !open.back().known)
        return; // the section has been reported
      const auto [first, is_new] = set_in_file_at.emplace(section + "/" + name, place);
      if (is_new)
        set(section, name, value, place);
      else
        error(place, quoted(name) + " is set twice; it was set first at " + first->second);
    }

    void
    Reader::read_override(const std::string &text)
    {
      const std::string place = "--set " + quoted(text);
      const auto        equal = text.find('=');
      const std::string path  = squeeze(text.substr(0, equal));
      const auto        slash = path.rfind('/');
      if (equal == std::string::npos || slash == std::string::npos)
        return error(place, "cannot be read; allowed: --set \"Section/Parameter=value\"");

      const std::string section = squeeze(path.substr(0, slash));
      const auto        known   = [&section](const ParameterInfo &parameter) { return parameter.section == section; };
      if (std::none_of(table.begin(), table.end(), known))
        return error(place, "unknown section " + quoted(section) + suggestion(section, subsections("")));
      set(section, squeeze(path.substr(slash + 1)), squeeze(text.substr(equal + 1)), place);
    }

    void
    Reader::report_unknown_parameter(const std::string &section, const std::string &name, const std::string &place)
    {
      const std::string where   = section.empty() ? " outside of all sections" : " in section " + quoted(section);
      const std::string message = "unknown parameter " + quoted(name) + where;
      for (const ParameterInfo &parameter : table)
        if (parameter.name == name)
          return error(place, message + "; it belongs to section " + quoted(parameter.section));
      error(place, message + suggestion(name, parameters(section)));
    }

    void
    Reader::set(const std::string &section, const std::string &name, const std::string &value, const std::string &place)
    {
      const auto matches   = [&](const ParameterInfo &p) { return p.section == section && p.name == name; };
      const auto parameter = std::find_if(table.begin(), table.end(), matches);
      if (parameter == table.end())
        return report_unknown_parameter(section, name, place);

      std::istringstream path(section);
      std::string        part;
      unsigned int       depth = 0;
      for (; std::getline(path, part, '/'); ++depth)
        prm.enter_subsection(part);
      try
        {
          prm.set(name, value);
          source.note(section + "/" + name, place);
        }
      catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &)
        {
          error(place, section + "/" + name + " = " + (value.empty() ? "(empty)" : value) + "; allowed: " + parameter->allowed);
        }
      for (; depth > 0; --depth)
        prm.leave_subsection();
    }

    ParameterSource
    Reader::finish() const
    {
      if (errors.empty())
        return source;
      std::string message;
      for (const std::string &line : errors)
        message += (message.empty() ? "" : "\n") + line;
      throw InputError(message);
    }
  } // namespace

  std::string
  ParameterSource::where(const std::string &path) const
  {
    const auto place = places.find(path);
    return place == places.end() ? "default" : place->second;
  }

  bool
  ParameterSource::is_set(const std::string &path) const
  {
    return places.count(path) > 0;
  }

  std::string
  ParameterSource::locate(const std::string &message) const
  {
    std::string place;
    auto        first = std::string::npos;
    for (const auto &[path, place_of_path] : places)
      if (message.find(path) < first)
        {
          first = message.find(path);
          place = place_of_path + ": ";
        }
    return place + message;
  }

  void
  ParameterSource::note(const std::string &path, const std::string &place)
  {
    places[path] = place;
  }

  ParameterSource
  read_parameter_text(dealii::ParameterHandler &prm, const std::string &text, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    Reader reader(prm);
    reader.read_text(text, file_name);
    for (const std::string &setting : overrides)
      reader.read_override(setting);
    return reader.finish();
  }

  std::string
  text_of_parameter_file(const std::string &file_name)
  {
    std::ifstream     file(file_name);
    std::stringstream text;
    // Of an empty file nothing can be copied, which is no error; a folder can be opened, but not read.
    const bool is_empty = file && file.peek() == std::ifstream::traits_type::eof() && !file.bad();
    if (!is_empty && !(file && text << file.rdbuf()))
      throw InputError("cannot read the parameter file " + quoted(file_name) + "; allowed: a readable file");
    return text.str();
  }

  ParameterSource
  read_parameter_file(dealii::ParameterHandler &prm, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    return read_parameter_text(prm, text_of_parameter_file(file_name), file_name, overrides);
  }
} // namespace tanktread
