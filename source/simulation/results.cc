// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#include <deal.II/base/mpi.h>

#include <Eigen/SparseCholesky>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_file.h>
#include <tanktread/fluid/field_output.h>
#include <tanktread/simulation/interior_pressure.h>
#include <tanktread/simulation/results.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/surface_operators.h>

#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace tanktread
{
  namespace
  {
    std::vector<std::string>
    names(const Row &row)
    {
      std::vector<std::string> result;
      for (const auto &column : row)
        result.push_back(column.first);
      return result;
    }

    std::vector<double>
    values(const Row &row)
    {
      std::vector<double> result;
      for (const auto &column : row)
        result.push_back(column.second);
      return result;
    }

    /** "_1" and so on where there are several capsules. */
    std::string
    suffix(const std::size_t c, const std::size_t n_capsules)
    {
      return n_capsules == 1 ? "" : "_" + std::to_string(c + 1);
    }

    /** With so many subdivisions the polygon that is cut is close to the smooth surface. */
    constexpr unsigned int contour_subdivisions = 2;

    /** Contents of one summary: capsule, mode, quantities. */
    using NumberedSummary = std::pair<unsigned int, std::pair<std::string, Row>>;

    /** Points of one shell and fields there. */
    struct ShellPoints
    {
      ControlPoints                                        positions;
      std::vector<std::pair<std::string, Eigen::MatrixXd>> fields;
    };

    ShellPoints
    shell_points(const Capsule &capsule, const LimitPicture &picture, const ControlPoints &x, const ControlPoints &velocity, const bool with_curvature)
    {
      const SparseMatrix                                      &limit   = picture.S();
      const SubdivisionSurface                                &surface = capsule.surface();
      const Eigen::VectorXd                                    weights = area_weights(surface, x);
      const ControlPoints                                      f       = capsule.shell().force(x);
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(mass_matrix(surface, weights));
      if (mass.info() != Eigen::Success)
        throw NumericalError("The fields on the shell cannot be drawn: its mass matrix at this shape is singular.");
      // Control values of the surface field nearest, in the mean square, to values at the quadrature points.
      const auto projected = [&](const Eigen::VectorXd &at_points) -> Eigen::VectorXd {
        return limit * Eigen::VectorXd(mass.solve(surface.S().transposed_times(weights.cwiseProduct(at_points))));
      };
      ShellPoints result{limit * x,
                         {{"normals", picture.normals(x)},
                          {"velocity", limit * velocity},
                          {"force_density", limit * Eigen::MatrixXd(mass.solve(Eigen::MatrixXd(f)))}}};
      result.fields.emplace_back("area_stretch", projected(weights.cwiseQuotient(capsule.shell().reference_weights())));
      if (with_curvature)
        result.fields.emplace_back("mean_curvature",
                                   surface.derivatives() == Derivatives::second
                                     ? projected(mean_curvature(surface, x))
                                     : Eigen::VectorXd(Eigen::VectorXd::Constant(limit.rows(), std::numeric_limits<double>::quiet_NaN())));
      return result;
    }

    /** Puts the fields of one shell below those of the others. */
    void
    append(const ShellPoints &shell, ShellPoints &all)
    {
      if (all.fields.empty())
        {
          all = shell;
          return;
        }
      const auto below = [](const Eigen::MatrixXd &upper, const Eigen::MatrixXd &lower) {
        Eigen::MatrixXd both(upper.rows() + lower.rows(), upper.cols());
        both << upper, lower;
        return both;
      };
      all.positions = below(all.positions, shell.positions);
      for (std::size_t k = 0; k < all.fields.size(); ++k)
        all.fields[k].second = below(all.fields[k].second, shell.fields[k].second);
    }

    Row
    summary_row(const MotionSummary &s)
    {
      Row result = {{"from", s.from},
                    {"end", s.end},
                    {"tank_treading_frequency", s.tank_treading_frequency},
                    {"tumbling_frequency", s.tumbling_frequency},
                    {"D_period", s.D_period},
                    {"D_frequency", 1. / s.D_period},
                    {"D_minimum", s.D_minimum},
                    {"D_maximum", s.D_maximum},
                    {"D_last", s.D_last},
                    {"theta_minimum", s.theta_minimum},
                    {"theta_maximum", s.theta_maximum},
                    {"theta_last", s.theta_last},
                    {"D_mean", s.means.D},
                    {"theta_mean", s.means.theta},
                    {"intrinsic_viscosity_mean", s.means.intrinsic_viscosity},
                    {"N1_mean", s.means.N1},
                    {"N2_mean", s.means.N2}};
      for (const auto &[quantity, limit] : s.limits.named())
        {
          result.emplace_back(quantity + "_limit", limit.value);
          result.emplace_back(quantity + "_limit_error", limit.error);
        }
      result.emplace_back("energy_defect", s.energy_defect);
      return result;
    }
  } // namespace


  Results::Results(const std::string &folder, const ShellLayout &layout, const unsigned int surface_subdivisions, const OutputProgress *const progress)
    : folder_(folder)
    , layout_(layout)
    , communicator_(layout.communicator())
    , n_capsules_(layout.n_capsules())
    , shell_series_(folder + "/shell.pvd")
    , fluid_series_(folder + "/fluid.pvd")
  {
    set_pictures(surface_subdivisions);
    on_first_rank(communicator_, [&] {
      std::size_t next = 0;
      open_tables([&](const std::string &file, const std::vector<std::string> &columns) {
        return progress == nullptr ? std::make_unique<CsvWriter>(file, columns)
                                   : std::make_unique<CsvWriter>(file, columns, std::streamoff(progress->tables.at(next++)));
      });
      if (progress == nullptr)
        return;
      shell_series_.set_entries(progress->shell_files);
      fluid_series_.set_entries(progress->fluid_files);
      n_fields_ = progress->n_fields;
    });
    n_fields_ = dealii::Utilities::MPI::broadcast(communicator_, n_fields_);
  }


  void
  Results::set_pictures(const unsigned int surface_subdivisions)
  {
    for (unsigned int k = 0; k < layout_.capsules().n_kinds(); ++k)
      {
        surface_pictures_.emplace_back(layout_.capsules().kind(k).topology(), surface_subdivisions);
        contour_pictures_.emplace_back(layout_.capsules().kind(k).topology(), contour_subdivisions);
      }
  }


  template <typename Function>
  void
  Results::open_tables(const Function &table)
  {
    std::vector<std::string> columns = names(history_row({}, {})), of_contours = {"time", "x", "z"};
    const unsigned int       n_files = n_capsules_ > most_files ? 1 : n_capsules_;
    if (n_files < n_capsules_)
      {
        columns.push_back("capsule");
        of_contours.push_back("capsule");
      }
    for (unsigned int c = 0; c < n_files; ++c)
      {
        const std::string end = suffix(c, n_files) + ".csv";
        histories_.push_back(table(folder_ + "/history" + end, columns));
        contours_.push_back(table(folder_ + "/contours" + end, of_contours));
      }
    suspension_ = table(folder_ + "/suspension.csv", names(suspension_row({}, {})));
  }


  OutputProgress
  Results::progress() const
  {
    OutputProgress result;
    if (!suspension_)
      return result;
    for (std::size_t c = 0; c < histories_.size(); ++c)
      for (const auto *const files : {&histories_, &contours_})
        result.tables.push_back((*files)[c]->written());
    result.tables.push_back(suspension_->written());
    result.n_fields    = n_fields_;
    result.shell_files = shell_series_.entries();
    result.fluid_files = fluid_series_.entries();
    return result;
  }


  Results::History
  Results::history(const ShellLayout &layout, const StepObservables &step, const std::vector<CapsuleObservables> &capsules)
  {
    std::vector<double> of_own;
    for (const CapsuleObservables &capsule : capsules)
      {
        const std::vector<double> row = values(history_row(step, capsule));
        of_own.insert(of_own.end(), row.begin(), row.end());
      }
    return layout.gathered(of_own, history_row(step, {}).size());
  }


  void
  Results::add_history(const StepObservables &step, const History &history, const SuspensionObservables &suspension)
  {
    on_first_rank(communicator_, [&] {
      const std::size_t n = history.size() / n_capsules_;
      for (unsigned int c = 0; c < n_capsules_; ++c)
        {
          std::vector<double> row(history.begin() + n * c, history.begin() + n * (c + 1));
          if (n_capsules_ > most_files)
            row.push_back(c + 1);
          histories_[n_capsules_ > most_files ? 0 : c]->row(row);
        }
      suspension_->row(values(suspension_row(step, suspension)));
    });
  }


  std::string
  Results::write_shells(const std::string &stem, const State &state, const ShellFields &velocities) const
  {
    bool has_curvature = false;
    for (unsigned int k = 0; k < layout_.capsules().n_kinds(); ++k)
      has_curvature = has_curvature || layout_.capsules().kind(k).surface().derivatives() == Derivatives::second;
    const bool is_one_file = layout_.n_teams() == 1;
    const auto piece       = [&](const unsigned int team) { return stem + (is_one_file ? "" : "." + std::to_string(team)) + ".vtu"; };
    on_all_ranks(communicator_, [&] {
      if (!layout_.leads() || layout_.n_own() == 0)
        return;
      ShellPoints                     all;
      std::vector<std::array<int, 3>> faces;
      std::vector<double>             number;
      for (unsigned int i = 0; i < layout_.n_own(); ++i)
        {
          const LimitPicture &picture = surface_pictures_[layout_.capsules().kind_of(layout_.own()[i])];
          const int           first   = int(number.size());
          append(shell_points(layout_.capsule(i), picture, state.capsules[i].x, velocities[i], has_curvature), all);
          for (const auto &face : picture.faces())
            faces.push_back({face[0] + first, face[1] + first, face[2] + first});
          number.resize(number.size() + picture.S().rows(), layout_.own()[i] + 1);
        }
      if (n_capsules_ > 1)
        all.fields.emplace_back("capsule", Eigen::VectorXd::Map(number.data(), number.size()));
      write_surface_vtu(folder_ + "/" + piece(layout_.team_of_rank(layout_.rank())), all.positions, faces, all.fields);
    });
    if (is_one_file)
      return piece(0);
    on_first_rank(communicator_, [&] {
      std::vector<std::pair<std::string, unsigned int>> fields = {{"normals", 3}, {"velocity", 3}, {"force_density", 3}, {"area_stretch", 1}};
      if (has_curvature)
        fields.emplace_back("mean_curvature", 1);
      fields.emplace_back("capsule", 1);
      std::set<unsigned int> teams;
      for (unsigned int c = 0; c < n_capsules_; ++c)
        teams.insert(layout_.team_of(c));
      std::vector<std::string> pieces;
      for (const unsigned int team : teams)
        pieces.push_back(piece(team));
      write_surface_pvtu(folder_ + "/" + stem + ".pvtu", pieces, fields);
    });
    return stem + ".pvtu";
  }


  void
  Results::add_contours(const double time, const ShellFields &x)
  {
    std::vector<std::pair<unsigned int, std::vector<double>>> of_own; // capsule; x and z of each point
    for (unsigned int i = 0; layout_.leads() && i < x.size(); ++i)
      {
        const LimitPicture      &picture = contour_pictures_[layout_.capsules().kind_of(layout_.own()[i])];
        const Eigen::RowVector3d middle(0., x[i].col(1).mean(), 0.);
        const ControlPoints      limit = picture.S() * (x[i].rowwise() - middle);
        TriangleMesh             mesh{{}, picture.faces()};
        for (Eigen::Index q = 0; q < limit.rows(); ++q)
          mesh.vertices.emplace_back(limit.row(q));
        of_own.emplace_back(layout_.own()[i], std::vector<double>());
        for (const Eigen::Vector2d &point : shear_plane_contour(mesh))
          of_own.back().second.insert(of_own.back().second.end(), point.data(), point.data() + 2);
      }
    const auto by_rank = dealii::Utilities::MPI::gather(communicator_, of_own);
    on_first_rank(communicator_, [&] {
      std::map<unsigned int, std::vector<double>> all;
      for (const auto &of_rank : by_rank)
        all.insert(of_rank.begin(), of_rank.end());
      for (const auto &[c, points] : all)
        for (std::size_t i = 0; i < points.size(); i += 2)
          if (n_capsules_ > most_files)
            contours_[0]->row({time, points[i], points[i + 1], c + 1.});
          else
            contours_[c]->row({time, points[i], points[i + 1]});
    });
  }


  void
  Results::add_fields(const double time, Scene &scene, const State &state, const ShellFields &velocities)
  {
    std::ostringstream number;
    number << std::setw(4) << std::setfill('0') << n_fields_;
    const InteriorPressure interior_pressure(scene, state);
    const std::string      fluid_file =
      write_fluid_fields(folder_, "fluid", n_fields_, scene.level().whole_space(), scene.level().whole_fields(state), scene.level().flow(), interior_pressure);
    const std::string shell_file = write_shells("shell_" + number.str(), state, velocities);
    add_contours(time, positions(state));
    on_first_rank(communicator_, [&] {
      shell_series_.add(time, shell_file);
      fluid_series_.add(time, fluid_file);
    });
    ++n_fields_;
  }


  void
  Results::write_summary(const std::string &outcome, const std::vector<MotionSummary> &capsules, const Row &of_run) const
  {
    std::vector<NumberedSummary> of_own;
    for (std::size_t i = 0; layout_.leads() && i < capsules.size(); ++i)
      of_own.emplace_back(layout_.own()[i], std::make_pair(word(capsules[i].mode), summary_row(capsules[i])));
    const auto by_rank = dealii::Utilities::MPI::gather(communicator_, of_own);
    on_first_rank(communicator_, [&] {
      std::map<unsigned int, std::pair<std::string, Row>> all;
      for (const auto &of_rank : by_rank)
        all.insert(of_rank.begin(), of_rank.end());
      std::ostringstream file;
      file << "quantity,value\noutcome," << outcome << '\n' << std::setprecision(10);
      for (const auto &[c, summary] : all)
        {
          const std::string end = suffix(c, n_capsules_);
          file << "mode" << end << ',' << summary.first << '\n';
          for (const auto &[quantity, value] : summary.second)
            file << quantity << end << ',' << value << '\n';
        }
      for (const auto &[quantity, value] : of_run)
        file << quantity << ',' << value << '\n';
      replace_file(folder_ + "/summary.csv", file.str());
    });
  }


  std::string
  Results::write_failed(const State &state) const
  {
    ShellFields rest;
    for (const CapsuleState &capsule : state.capsules)
      rest.push_back(ControlPoints::Zero(capsule.x.rows(), 3));
    return folder_ + "/" + write_shells("failed_shell", state, rest);
  }
} // namespace tanktread
