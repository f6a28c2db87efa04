#include <cmath>
#include <limits>
#include <span>

#include "scene/scene.hpp"

namespace dolp {
namespace {

using Coefficients = std::span<const double>;

/// The sum of term(c[i], c[i + 1]) over i = first, first + 2, ... In all formulas c[0] is C1, c[1] is C2, and so on.
template <class Term>
double sum_of_pairs(Coefficients c, std::size_t first, const Term& term) {
  double sum = 0.0;
  for (std::size_t i = first; i + 1 < c.size(); i += 2) sum += term(c[i], c[i + 1]);
  return sum;
}

double at_or_zero(Coefficients c, std::size_t i) { return i < c.size() ? c[i] : 0.0; }

/// The term C2 l^C3 / (l^2 - C4^C5) at the wavelength l, where c[first] is C2. 0 if its coefficients are missing.
double resonance(Coefficients c, std::size_t first, double l) {
  if (first + 3 >= c.size() || c[first] == 0.0) return 0.0;
  return c[first] * std::pow(l, c[first + 1]) / (l * l - std::pow(c[first + 2], c[first + 3]));
}

}  // namespace

double Dispersion::at(double wavelength_um) const {
  const Coefficients c = coefficients;
  const double l = wavelength_um;
  const double l2 = l * l;
  const auto power = [l](double factor, double exponent) { return factor * std::pow(l, exponent); };
  switch (number) {
    case 1:  // Sellmeier: n^2 - 1 = C1 + C2 l^2 / (l^2 - C3^2) + …
      return std::sqrt(1.0 + c[0] + sum_of_pairs(c, 1, [&](double a, double b) { return a * l2 / (l2 - b * b); }));
    case 2:  // Sellmeier-2: n^2 - 1 = C1 + C2 l^2 / (l^2 - C3) + …
      return std::sqrt(1.0 + c[0] + sum_of_pairs(c, 1, [&](double a, double b) { return a * l2 / (l2 - b); }));
    case 3:  // polynomial: n^2 = C1 + C2 l^C3 + …
      return std::sqrt(c[0] + sum_of_pairs(c, 1, power));
    case 4:  // RefractiveIndex.INFO: n^2 = C1 + C2 l^C3 / (l^2 - C4^C5) + C6 l^C7 / (l^2 - C8^C9) + C10 l^C11 + …
      return std::sqrt(c[0] + resonance(c, 1, l) + resonance(c, 5, l) + sum_of_pairs(c, 9, power));
    case 5:  // Cauchy: n = C1 + C2 l^C3 + …
      return c[0] + sum_of_pairs(c, 1, power);
    case 6:  // gases: n - 1 = C1 + C2 / (C3 - l^-2) + …
      return 1.0 + c[0] + sum_of_pairs(c, 1, [&](double a, double b) { return a / (b - 1.0 / l2); });
    case 7: {  // Herzberger: n = C1 + C2 L + C3 L^2 + C4 l^2 + C5 l^4 + C6 l^6, L = 1 / (l^2 - 0.028)
      const double pole = 1.0 / (l2 - 0.028);
      return c[0] + at_or_zero(c, 1) * pole + at_or_zero(c, 2) * pole * pole +
             l2 * (at_or_zero(c, 3) + l2 * (at_or_zero(c, 4) + l2 * at_or_zero(c, 5)));
    }
    case 8: {  // retro: (n^2 - 1) / (n^2 + 2) = C1 + C2 l^2 / (l^2 - C3) + C4 l^2
      const double ratio = c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2;
      return std::sqrt((1.0 + 2.0 * ratio) / (1.0 - ratio));
    }
    case 9: {  // exotic: n^2 = C1 + C2 / (l^2 - C3) + C4 (l - C5) / ((l - C5)^2 + C6)
      const double offset = l - c[4];
      return std::sqrt(c[0] + c[1] / (l2 - c[2]) + c[3] * offset / (offset * offset + c[5]));
    }
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<std::size_t> coefficient_counts(int number) {
  switch (number) {
    case 4:
      return {1, 5, 9, 11, 13, 15, 17};
    case 5:
    case 6:
      return {1, 3, 5, 7, 9, 11};
    case 7:
      return {1, 2, 3, 4, 5, 6};
    case 8:
      return {4};
    case 9:
      return {6};
    default:
      return {1, 3, 5, 7, 9, 11, 13, 15, 17};
  }
}

}  // namespace dolp
