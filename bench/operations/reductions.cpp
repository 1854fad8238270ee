// Reductions over a lane's bands, and its colour.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "bench/operations/operation.hpp"
#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"

namespace spectile::measure {
namespace {

Operation& spectrum_operation(std::vector<Operation>& to, std::string name, std::size_t planes,
                              std::size_t bands) {
  Operation& out = add_operation(to, "over the bands", std::move(name), "spectrum", {planes, bands}, {1, 1});
  out.fill = uniform_values(planes * bands, 0.01F, 1.0F);
  return out;
}

void add_extremes(std::vector<Operation>& to, std::size_t bands) {
  const auto extreme = [&](const char* name, auto kernel, bool least) {
    Operation& op = spectrum_operation(to, name, 1, bands);
    op.operations = 2 * static_cast<double>(bands);  // compare, choose
    op.unit = "exact";
    op.run = [=](const KernelTable& k, const Arrays& a) { (k.*kernel)(a.out(), a.in(), bands, a.blocks); };
    op.error = error_against(1, 1, true, 0, [=](const double* v, double* reference, double* /*scale*/) {
      reference[0] = least ? kBeyond : -kBeyond;
      for (std::size_t i = 0; i < bands; ++i) {
        if (least ? v[i] < reference[0] : reference[0] < v[i]) reference[0] = v[i];
      }
    });
  };
  extreme("minimum", &KernelTable::minimum, true);
  extreme("maximum", &KernelTable::maximum, false);
}

void add_masks(std::vector<Operation>& to, std::size_t bands) {
  const auto mask = [&](const char* name, std::size_t planes, auto run, auto is_reference) {
    Operation& op = spectrum_operation(to, name, planes, bands);
    op.operations = static_cast<double>(bands);
    op.unit = "exact";
    op.out.element = Element::kMask;
    op.run = run;
    op.error = [=](const double* in, const double* out, double /*tiny*/) {
      return (out[0] != 0) == is_reference(in) ? 0.0 : kBeyond;
    };
  };
  const auto of_one = [=](auto kernel) {
    return [=](const KernelTable& k, const Arrays& a) {
      (k.*kernel)(a.out<std::uint64_t>(), a.in(), bands, a.blocks);
    };
  };
  mask("is_black", 1, of_one(&KernelTable::black_mask),
       [=](const double* v) { return std::all_of(v, v + bands, [](double x) { return x == 0; }); });
  to.back().bitwise = true;
  // The scan ends at the first sample that is not 0: only black lanes are scanned whole.
  to.back().fill = uniform_values(bands, 0.0F, 0.0F);
  mask("has_nan", 1, of_one(&KernelTable::nan_mask),
       [=](const double* v) { return std::any_of(v, v + bands, [](double x) { return std::isnan(x); }); });
  mask(
      "equal_lanes", 2,
      [=](const KernelTable& k, const Arrays& a) {
        k.equal_mask(a.out<std::uint64_t>(), a.in(0), a.in(1), bands, a.blocks);
      },
      [=](const double* v) { return std::equal(v, v + bands, v + bands); });
  to.back().fill = [=](Random& random, float* values) {
    for (std::size_t i = 0; i < bands; ++i) values[i] = values[bands + i] = uniform(random, 0.01F, 1.0F);
  };
}

/// Sums of `count` rows of weights [bands] times samples, in double.
Oracle weighted_by(const std::shared_ptr<const std::vector<double>>& weights, std::size_t bands,
                   std::size_t count) {
  return [=](const double* v, double* reference, double* scale) {
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < bands; ++i) {
        const double term = (*weights)[k * bands + i] * v[i];
        reference[k] += term;
        scale[k] += std::abs(term);
      }
    }
  };
}

/// Products, sums within runs of eight, sums of the runs.
double sums_of(double count) {
  return count + std::ceil(count / static_cast<double>(kernels::kSumRun));
}

/// The three weighted sums of a projector, of all its samples.
void add_projection(std::vector<Operation>& to, const char* name,
                    const std::shared_ptr<const Projector>& projector) {
  const std::size_t n = projector->weights().size();
  const auto count = static_cast<double>(n);
  auto weights = std::make_shared<std::vector<double>>(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) (*weights)[k * n + i] = projector->weights()[i][k];
  }
  Operation& xyz = spectrum_operation(to, name, 1, n);
  xyz.group = "colorimetry";
  xyz.out = {3, 1};
  xyz.operations = 3 * (count + sums_of(count));
  xyz.bound = count / 8 + 11;
  xyz.bottleneck =
      "six operations a vector beside its load: the processor does not see far enough ahead to hide all of "
      "memory";
  xyz.run = [=](const KernelTable& k, const Arrays& a) {
    k.project(a.out3().data(), a.in(), ProjectorAccess::weights(*projector), n, a.blocks);
  };
  xyz.error = error_against(3, count, false, xyz.bound, weighted_by(weights, n, 3));
}

/// Reflectances that re-radiate from each of 40 bands at every longer wavelength: 820 samples a pixel.
Result<void> add_reradiation(std::vector<Operation>& to, const MeasuredSpectrum& light) {
  SPECTILE_ASSIGN(const auto bands, Bands::uniform(380, 780, 10));
  std::vector<BandPair> pairs;
  for (std::size_t from = 0; from < bands.count(); ++from) {
    for (std::size_t to_band = from + 1; to_band < bands.count(); ++to_band) pairs.push_back({from, to_band});
  }
  SPECTILE_ASSIGN(auto made, Projector::reradiating(bands, light, pairs));
  add_projection(to, "project re-radiation to XYZ", std::make_shared<const Projector>(std::move(made)));
  to.back().item = "pixel of 820 samples";
  return {};
}

}  // namespace

Result<void> add_reductions(std::vector<Operation>& to, const Bands& bands) {
  const std::size_t n = bands.count();
  const auto count = static_cast<double>(n);
  add_extremes(to, n);
  add_masks(to, n);

  SPECTILE_ASSIGN(auto light, illuminant("D65"));
  SPECTILE_ASSIGN(auto made, Projector::reflective(bands, light));
  const auto projector = std::make_shared<const Projector>(std::move(made));
  add_projection(to, "project to XYZ", projector);

  auto luminances = std::make_shared<std::vector<double>>();
  for (const auto& w : projector->weights()) luminances->push_back(w[1]);
  Operation& y = spectrum_operation(to, "luminance", 1, n);
  y.group = "colorimetry";
  y.operations = count + sums_of(count);
  y.bound = count / 8 + 11;
  y.run = [=](const KernelTable& k, const Arrays& a) {
    k.weighted_sum(a.out(), a.in(), ProjectorAccess::luminance_weights(*projector), n, a.blocks);
  };
  y.error = error_against(1, count, false, y.bound, weighted_by(luminances, n, 1));

  Operation& transform = add_operation(to, "colorimetry", "XYZ to linear sRGB", "colour", {3, 1}, {3, 1});
  transform.operations = 15;
  transform.bound = 4;  // the matrix's own rounding, a product, two sums
  transform.fill = uniform_values(3, 0.01F, 1.0F);
  const Matrix3 exact = xyz_to_srgb_matrix();
  std::array<float, 9> matrix{};
  for (std::size_t i = 0; i < 9; ++i) matrix[i] = static_cast<float>(exact[i]);
  transform.run = [=](const KernelTable& k, const Arrays& a) {
    k.transform3(a.out3().data(), a.in3().data(), matrix.data(), a.n());
  };
  transform.error =
      error_against(3, 3, false, transform.bound, [=](const double* v, double* reference, double* scale) {
        for (std::size_t i = 0; i < 9; ++i) {
          const double term = exact[i] * v[i % 3];
          reference[i / 3] += term;
          scale[i / 3] += std::abs(term);
        }
      });
  return add_reradiation(to, light);
}

}  // namespace spectile::measure
