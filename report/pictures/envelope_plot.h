#pragma once

#include "report/live/chart.h"
#include "report/pictures/plot_style.h"
#include "results/fits/hoek_brown.h"
#include "results/folder/reference.h"
#include "results/runs/series.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::plot
{
struct CurveLooks
{
  double width;
  int dashes;
  std::string colour;
};

/// A fit in the key of a picture: H–B intact, with σ_t.
std::string label_of(const HoekBrownFit& fit);

/// The curves of a picture of strengths over confinement, and their range.
class EnvelopePlot
{
public:
  void take_in(double sigma_3, double sigma_1);

  void add_points(const Series& series, std::size_t n);

  /// The residual strengths: marks of the same form, open, along a thin line.
  void add_residual(const Series& series, std::size_t n);

  /// Between two confinements.
  void add_curve(const std::function<double(double)>& sigma_1, double begin, double end, const CurveLooks& looks,
                 const std::string& label);

  /// As far as its points go, beyond which nothing is known of it.
  template <typename Fit>
  void add_fit(const Fit& fit, const CurveLooks& looks, const std::string& label)
  {
    add_curve([&](const double x) { return fit.sigma_1(x); }, fit.quality.lowest_sigma_3(),
              fit.quality.highest_sigma_3(), looks, label);
  }

  void add_reference(const Reference& reference);

  /// What a source prints as parameters, from its beginning to the largest σ₃ of the source's points; to the end of the
  /// plot, which must be known, where it has none under confinement.
  void add_printed(const ReferenceSource& source, const char* of_colour);

  /// The curve through the points of the experiment.
  void add_fit_of(const ReferenceSource& experiment);

  void add_rock_curves(const Reference& reference);

  /// Where the intact form begins, up to its uniaxial strength.
  void add_cut_off(const HoekBrownFit& fit, const std::string& of_colour);

  /// The part up to these stresses, or all of it [Pa].
  std::string script(const std::optional<EnvelopePoint>& upper = std::nullopt) const;

  /// The same for the page.
  std::string json(const std::optional<EnvelopePoint>& upper = std::nullopt) const;

  bool empty() const { return first.empty() && later.empty(); }

  /// Of the picture [px].
  int height() const { return 640 + key.further_height(width); }

  static constexpr int width = 660; ///< [px]
  double lowest_3 = 0.0;
  double highest_3 = 0.0;
  double highest_1 = 0.0;

private:
  static constexpr const char* x_label = "confinement σ₃ [MPa], compression positive";
  static constexpr const char* y_label = "strength σ₁ [MPa]";
  static constexpr int mark_of_experiment = 8; // open triangle
  static constexpr int mark_of_model = 4;      // open square

  void draw_strengths(const ReferenceSource& source, int mark, const std::string& looks, const char* of_colour);

  /// From and to on either axis [MPa].
  std::array<double, 4> part_up_to(const std::optional<EnvelopePoint>& upper) const;

  std::string add_data(const std::string& rows);

  std::string data;
  std::vector<std::string> first; ///< curves
  std::vector<std::string> later; ///< points, drawn over them
  std::vector<ChartLine> of_page;
  ColumnKey key;
  int n_blocks = 0;
};
} // namespace feldspar::plot
