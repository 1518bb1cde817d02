// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how far the curves of two runs are apart, and how much of that is a delay.

#include <Eigen/QR>
#include <tanktread/simulation/curve_difference.h>
#include <tanktread/simulation/time_interpolation.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tanktread
{
  namespace
  {
    using Eigen::Index;
    using Eigen::MatrixXd;
    using Eigen::VectorXd;

    constexpr double  pi              = 3.14159265358979323846;
    constexpr Index   n_grid          = 2001;
    const char *const plain_columns[] = {"L", "B", "W", "intrinsic_viscosity", "N1", "N2"};

    double
    root_mean_square(const VectorXd &x)
    {
      return x.norm() / std::sqrt(double(x.size()));
    }

    std::vector<std::string>
    split(const std::string &line)
    {
      std::istringstream       stream(line);
      std::vector<std::string> result;
      std::string              word;
      while (std::getline(stream, word, ','))
        result.push_back(word);
      return result;
    }

    /** By central differences, at the ends by one-sided ones. */
    VectorXd
    slope(const VectorXd &x, const double step)
    {
      const Index n = x.size();
      VectorXd    result(n);
      result.segment(1, n - 2) = (x.tail(n - 2) - x.head(n - 2)) / (2. * step);
      result[0]                = (x[1] - x[0]) / step;
      result[n - 1]            = (x[n - 1] - x[n - 2]) / step;
      return result;
    }

    MatrixXd
    at(const VectorXd &times, const HistoryCurves &curves)
    {
      MatrixXd result(times.size(), curves.values.cols());
      for (Index n = 0; n < times.size(); ++n)
        result.row(n) = interpolated(curves.times, curves.values, times[n]);
      return result;
    }

    /** Angle of the section from that of `other`, in units of pi; zero where one of them is round. */
    VectorXd
    turns(const Eigen::VectorXcd &section, const Eigen::VectorXcd &other)
    {
      return (section.array() * other.array().conjugate()).arg() / (2. * pi);
    }

    Eigen::VectorXcd
    section(const MatrixXd &values)
    {
      Eigen::VectorXcd result(values.rows());
      result.real() = values.col(0);
      result.imag() = values.col(1);
      return result;
    }

    void
    compare_sections(const VectorXd &times, const Eigen::VectorXcd &x, const Eigen::VectorXcd &y, std::map<std::string, CurveDifference> &result)
    {
      const double   step    = times[1] - times[0];
      const Index    n       = x.size();
      const VectorXd D       = x.cwiseAbs();
      const double   largest = D.maxCoeff();
      result["D"]            = curve_difference(times, D, slope(D, step), D - y.cwiseAbs());
      if (!(largest > 0.))
        return;
      const VectorXd weight  = D / largest;
      VectorXd       rate    = VectorXd::Zero(n);
      rate.segment(1, n - 2) = turns(x.tail(n - 2), x.head(n - 2)) / (2. * step);
      const VectorXd theta   = x.array().arg() / (2. * pi);
      result["theta"]        = curve_difference(times, weight.cwiseProduct(theta), weight.cwiseProduct(rate), weight.cwiseProduct(turns(x, y)));
    }
  } // namespace


  CurveDifference
  curve_difference(const VectorXd &times, const VectorXd &x, const VectorXd &slope, const VectorXd &d)
  {
    MatrixXd delays(times.size(), 2);
    delays << slope, slope.cwiseProduct((times.array() - times.mean()).matrix());
    const VectorXd rest = d - delays * delays.colPivHouseholderQr().solve(d);
    const double   size = root_mean_square(rest), rate = root_mean_square(slope);
    return {x.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff(), std::abs(d[d.size() - 1]), size, rate > 0. ? size / rate : 0.};
  }


  HistoryCurves
  history_curves(const std::string &file)
  {
    std::ifstream            stream(file);
    std::string              line;
    HistoryCurves            result;
    std::vector<std::size_t> columns;
    std::getline(stream, line);
    const std::vector<std::string> names = split(line);
    for (const std::string name :
         {"time", "D_xz", "theta", plain_columns[0], plain_columns[1], plain_columns[2], plain_columns[3], plain_columns[4], plain_columns[5]})
      columns.push_back(std::find(names.begin(), names.end(), name) - names.begin());
    if (*std::max_element(columns.begin(), columns.end()) >= names.size())
      return result;
    std::vector<std::vector<double>> rows;
    while (std::getline(stream, line))
      {
        const std::vector<std::string> words = split(line);
        if (words.size() != names.size())
          break;
        std::vector<double> row;
        for (const std::size_t column : columns)
          row.push_back(std::strtod(words[column].c_str(), nullptr));
        result.times.push_back(row[0]);
        const std::complex<double> direction = std::isfinite(row[2]) ? std::polar(row[1], 2. * pi * row[2]) : 0.;
        row[1]                               = direction.real();
        row[2]                               = direction.imag();
        rows.push_back(row);
      }
    result.values.resize(rows.size(), columns.size() - 1);
    for (std::size_t n = 0; n < rows.size(); ++n)
      result.values.row(n) = Eigen::Map<const Eigen::RowVectorXd>(rows[n].data() + 1, result.values.cols());
    return result;
  }


  std::map<std::string, CurveDifference>
  curve_differences(const HistoryCurves &run, const HistoryCurves &companion)
  {
    std::map<std::string, CurveDifference> result;
    if (run.times.size() < 4 || companion.times.size() < 4)
      return result;
    const VectorXd times =
      VectorXd::LinSpaced(n_grid, std::max(run.times.front(), companion.times.front()), std::min(run.times.back(), companion.times.back()));
    if (!(times[n_grid - 1] > times[0]))
      return result;
    const MatrixXd x = at(times, run), y = at(times, companion);
    if (x.leftCols(2).allFinite() && y.leftCols(2).allFinite())
      compare_sections(times, section(x), section(y), result);
    Index column = 2;
    for (const std::string name : plain_columns)
      {
        if (x.col(column).allFinite() && y.col(column).allFinite())
          result[name] = curve_difference(times, x.col(column), slope(x.col(column), times[1] - times[0]), x.col(column) - y.col(column));
        ++column;
      }
    return result;
  }
} // namespace tanktread
