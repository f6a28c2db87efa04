#include "model/films.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace dolp {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kFourPi = 4.0 * std::numbers::pi;
constexpr double kFilmRounding = 16.0 * std::numeric_limits<double>::epsilon();

// Facets whose film differs from the mean by more than this many spreads are left out: 3e-12 of them.
constexpr double kReachInSpreads = 7.0;
// Means over the thickness leave out harmonics of a fringe whose amplitude is below this.
constexpr double kLeastHarmonic = 1e-11;
constexpr double kMostHarmonics = 400.0;

// The operators * and / of std::complex and std::sqrt guard against overflow and NaN. Here nothing overflows, and the
// functions below take a fraction of the time.
inline Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

inline Complex quotient(Complex a, Complex b) {
  const double inverse = 1.0 / (b.real() * b.real() + b.imag() * b.imag());
  return {(a.real() * b.real() + a.imag() * b.imag()) * inverse, (a.imag() * b.real() - a.real() * b.imag()) * inverse};
}

/// Domain: an imaginary part of at least 0, which the root has, too.
Complex root(Complex square) {
  const double x = square.real(), y = square.imag();
  if (y == 0.0) return x >= 0.0 ? Complex(std::sqrt(x), 0.0) : Complex(0.0, std::sqrt(-x));
  const double larger = std::sqrt(0.5 * (std::sqrt(x * x + y * y) + std::abs(x)));
  const double smaller = larger > 0.0 ? 0.5 * y / larger : 0.0;
  return x >= 0.0 ? Complex(larger, smaller) : Complex(smaller, larger);
}

/// A medium at one angle: N^2, and q = sqrt(N^2 - sin^2 beta) with an imaginary part of at least 0.
struct Wave {
  Complex square;
  Complex q;
};

Wave wave_in(const OpticalConstants& index, double cosine) {
  const double n = index.n, k = index.k;
  const Complex square((n - k) * (n + k), 2.0 * n * k);
  return {square, root({(n - 1.0) * (n + 1.0) - k * k + cosine * cosine, square.imag()})};
}

/// Tangential fields of s or p light at a depth. `flux` / `field` is the admittance q (s) or q / N^2 (p) of the wave
/// there.
struct Fields {
  Complex field;
  Complex flux;
};

struct BothFields {
  Fields s;
  Fields p;
};

/// 1 - z and (1 - z) / q, with z = exp(2 i delta) of a film.
struct Passage {
  Complex difference;
  Complex over_q;
};

Complex one_minus_z(const Wave& film, double thickness) {
  const double scale = kFourPi * thickness;
  // z is passed (cos + i sin). Half the angle gives 1 - z without cancellation.
  const double absorbed = -std::expm1(-scale * film.q.imag());
  const double passed = 1.0 - absorbed;
  const double sine = std::sin(0.5 * scale * film.q.real());
  const double imaginary = 2.0 * passed * sine * std::cos(0.5 * scale * film.q.real());
  return {absorbed + 2.0 * passed * sine * sine, -imaginary};
}

Passage passage(const Wave& film, double thickness) {
  const Complex difference = one_minus_z(film, thickness);
  return {difference, film.q == 0.0 ? Complex(0.0, -kFourPi * thickness) : quotient(difference, film.q)};
}

/// The fields above a film, times 2 exp(i delta), so that nothing overflows in thick films.
BothFields above(const BothFields& below, const Wave& film, const Passage& through) {
  const Complex sum = 2.0 - through.difference;
  const Complex times_q = product(film.q, through.difference);
  const auto& [s, p] = below;
  return {{product(sum, s.field) + product(through.over_q, s.flux), product(times_q, s.field) + product(sum, s.flux)},
          {product(sum, p.field) + product(product(film.square, through.over_q), p.flux),
           product(quotient(times_q, film.square), p.field) + product(sum, p.flux)}};
}

/// r = top / bottom. Amplitudes of single interfaces would be 0 / 0 where two of them cancel, as at grazing incidence
/// on n = 1, so they do not occur.
struct Ratio {
  Complex top;
  Complex bottom;
};

Ratio ratio(const Fields& fields, double cosine) {
  return {cosine * fields.field - fields.flux, cosine * fields.field + fields.flux};
}

FilmReflection products(Complex r_s, Complex r_p) {
  return {std::norm(r_s), std::norm(r_p), product(std::conj(r_s), r_p)};
}

/// A stack at one angle of incidence.
class Stack {
 public:
  Stack(const FacetOptics& optics, double cosine) : cosine_(cosine), medium_(wave_in(optics.index, cosine)) {
    for (const Film& film : optics.films) {
      waves_.push_back(wave_in(film.index, cosine));
      thickness.push_back(film.thickness);
    }
  }

  const Wave& wave(std::size_t film) const { return waves_[film]; }

  /// The fields outside. `own` replaces the passage through the film `of`.
  BothFields fields(std::optional<std::size_t> of = {}, const Passage& own = {}) const {
    BothFields fields{{1.0, medium_.q}, {1.0, quotient(medium_.q, medium_.square)}};
    for (std::size_t j = waves_.size(); j-- > 0;)
      fields = above(fields, waves_[j], of == j ? own : passage(waves_[j], thickness[j]));
    return fields;
  }

  FilmReflection reflection() const {
    const BothFields outside = fields();
    const Ratio s = ratio(outside.s, cosine_), p = ratio(outside.p, cosine_);
    return products(quotient(s.top, s.bottom), quotient(p.top, p.bottom));
  }

  SmoothAbsorptance absorptance() const {
    // Each film adds a few roundings of the fields. Where light is nearly all reflected, their net flux is a
    // difference.
    const double rounding = kFilmRounding * static_cast<double>(1 + waves_.size());
    const BothFields outside = fields();
    SmoothAbsorptance absorbed;
    const auto take = [&](const Fields& f) {
      const Ratio r = ratio(f, cosine_);
      const double reflected = std::norm(r.top) / std::norm(r.bottom);
      const bool is_small = reflected < 0.5;
      const double scale = 4.0 * cosine_ / std::norm(r.bottom);
      const double error = is_small ? 1.0 : scale * std::sqrt(std::norm(f.field) * std::norm(f.flux));
      absorbed.error = std::max(absorbed.error, rounding * error);
      if (is_small) return 1.0 - reflected;
      return std::max(scale * (f.field.real() * f.flux.real() + f.field.imag() * f.flux.imag()), 0.0);
    };
    absorbed.s = take(outside.s);
    absorbed.p = take(outside.p);
    return absorbed;
  }

  double cosine() const { return cosine_; }

  std::vector<double> thickness;  ///< of the films, in wavelengths

 private:
  double cosine_;
  Wave medium_;
  std::vector<Wave> waves_;
};

/// r as a function of the thickness of one film, through its z = exp(2 i delta): r = first + amplitude z / (1 - fall
/// z).
class FilmSeries {
 public:
  FilmSeries(const Stack& stack, std::size_t film) : wave_(stack.wave(film)) {
    if (wave_.q == 0.0) wave_.q = kSmallestQ;
    // Top and bottom of r are linear in 1 - z: `whole` + (1 - z) `slope`.
    const BothFields at_1 = stack.fields(film, {0.0, 0.0});
    const BothFields at_0 = stack.fields(film, {1.0, quotient(1.0, wave_.q)});
    const std::array<Ratio, 2> whole = {ratio(at_1.s, stack.cosine()), ratio(at_1.p, stack.cosine())};
    const std::array<Ratio, 2> without = {ratio(at_0.s, stack.cosine()), ratio(at_0.p, stack.cosine())};
    for (std::size_t i = 0; i < 2; ++i) {
      const Ratio slope{without[i].top - whole[i].top, without[i].bottom - whole[i].bottom};
      const Complex square = product(without[i].bottom, without[i].bottom);
      first_[i] = quotient(without[i].top, without[i].bottom);
      fall_[i] = quotient(slope.bottom, without[i].bottom);
      amplitude_[i] = quotient(product(whole[i].top, slope.bottom) - product(slope.top, whole[i].bottom), square);
    }
  }

  /// Products of the amplitudes at a thickness.
  FilmReflection at(double thickness) const {
    const Complex z = 1.0 - one_minus_z(wave_, thickness);
    const auto r = [&](std::size_t i) {
      return first_[i] + quotient(product(amplitude_[i], z), 1.0 - product(fall_[i], z));
    };
    return products(r(0), r(1));
  }

  /// Products of the amplitudes at a thickness, without the terms z^m conj(z)^n with |m - n| > `most`. Domain: |z| so
  /// small that the series converge, as where harmonics() is below kMostHarmonics.
  FilmReflection at(double thickness, int most) const {
    const Complex z = 1.0 - one_minus_z(wave_, thickness);
    const std::array<Complex, 2> falls = {product(fall_[0], z), product(fall_[1], z)};
    const std::array<Complex, 2> series = {powers(falls[0], most), powers(falls[1], most)};
    const std::array<Complex, 2> turned = {product(amplitude_[0], z), product(amplitude_[1], z)};
    const auto mean_square = [&](std::size_t i) {
      const double equal = std::norm(turned[i]) / (1.0 - std::norm(falls[i]));
      const Complex more = product(std::conj(first_[i]), turned[i]) + equal * falls[i];
      return std::norm(first_[i]) + equal + 2.0 * product(more, series[i]).real();
    };
    const Complex equal =
        quotient(product(std::conj(turned[0]), turned[1]), 1.0 - product(std::conj(falls[0]), falls[1]));
    const Complex more = product(std::conj(first_[0]), turned[1]) + product(equal, falls[1]);
    const Complex fewer = product(first_[1], std::conj(turned[0])) + product(equal, std::conj(falls[0]));
    return {mean_square(0), mean_square(1),
            product(std::conj(first_[0]), first_[1]) + equal + product(more, series[1]) +
                product(fewer, std::conj(series[0]))};
  }

  /// at(thickness, 0), faster.
  FilmReflection mean_over_phase(double thickness) const {
    const double square = std::exp(-2.0 * kFourPi * wave_.q.imag() * thickness);
    const auto mean = [&](std::size_t i) {
      return std::norm(first_[i]) + square * std::norm(amplitude_[i]) / (1.0 - square * std::norm(fall_[i]));
    };
    const Complex pair = product(std::conj(amplitude_[0]), amplitude_[1]);
    const Complex falls = product(std::conj(fall_[0]), fall_[1]);
    return {mean(0), mean(1), product(std::conj(first_[0]), first_[1]) + square * quotient(pair, 1.0 - square * falls)};
  }

  /// The largest ratio of a harmonic to the harmonic before, at a thickness. Evanescent waves may have ratios above 1.
  double largest_ratio(double thickness) const {
    const double modulus = std::exp(-kFourPi * wave_.q.imag() * thickness);
    return std::max(std::abs(fall_[0]), std::abs(fall_[1])) * modulus;
  }

  /// Harmonics of a fringe with an amplitude of at least kLeastHarmonic, at a thickness.
  double harmonics(double thickness) const {
    const double falls = largest_ratio(thickness);
    if (falls >= 1.0) return kMostHarmonics;
    return std::clamp(std::ceil(std::log(kLeastHarmonic) / std::log(falls)), 1.0, kMostHarmonics);
  }

 private:
  static constexpr double kSmallestQ = 1e-100;

  /// 1 + w + w^2 + ... with `count` terms.
  static Complex powers(Complex w, int count) {
    Complex last(1.0);
    for (int i = 0; i < count; ++i) last = product(last, w);
    return quotient(1.0 - last, 1.0 - w);
  }

  Wave wave_;
  std::array<Complex, 2> first_, amplitude_, fall_;  // of s and p
};

void add(FilmReflection& sum, const FilmReflection& more, double weight) {
  sum.r_s += weight * more.r_s;
  sum.r_p += weight * more.r_p;
  sum.cross += weight * more.cross;
}

/// True if thickness 0 cuts off a part of the distribution that matters: more than 3e-7 of the facets.
bool is_cut(const Film& film) {
  constexpr double kReachOfCut = 5.0;
  return film.thickness < kReachOfCut * film.spread;
}

/// True if the end of the distribution at thickness 0 keeps a part of a fringe with the frequency. The part is about
/// the density there, divided by the frequency.
bool ends_sharply(const Film& film, double frequency) {
  constexpr double kLeastPart = 1e-5;
  const double off = film.thickness / film.spread;
  return std::exp(-0.5 * off * off) / std::sqrt(kTwoPi) > kLeastPart * frequency * film.spread;
}

/// The mean of f(thickness) over the normal distribution of a film's thickness, by the trapezoidal rule. It converges
/// faster than any power of the step if f has no frequency above `most_frequency` (radians per wavelength), as long as
/// thickness 0 does not cut it. There the weights are Gregory's for an error of order h^4.
template <class Function>
FilmReflection mean_over_thickness(const Film& film, double most_frequency, const Function& f) {
  constexpr double kStepAtZero = 0.05;  // in spreads; with `most_frequency`, the error is then below 1e-6
  constexpr std::array<double, 3> kAtZero = {3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0};
  const double least = std::max(film.thickness - kReachInSpreads * film.spread, 0.0);
  const double most = film.thickness + kReachInSpreads * film.spread;
  double step = kTwoPi / (most_frequency + kReachInSpreads / film.spread);
  if (is_cut(film)) step = std::min(0.25 * step, kStepAtZero * film.spread);
  FilmReflection mean;
  double weights = 0.0;
  for (double i = std::ceil(least / step); i * step <= most; ++i) {
    const double off = (i * step - film.thickness) / film.spread;
    const bool is_at_end = is_cut(film) && i < static_cast<double>(kAtZero.size());
    const double weight = (is_at_end ? kAtZero[static_cast<std::size_t>(i)] : 1.0) * std::exp(-0.5 * off * off);
    add(mean, f(i * step), weight);
    weights += weight;
  }
  FilmReflection scaled;
  add(scaled, mean, 1.0 / weights);
  return scaled;
}

/// The mean over the thickness of one film. The other films keep the thickness of `stack`.
FilmReflection film_mean(const Stack& stack, const Film& film, std::size_t number) {
  const FilmSeries reflection(stack, number);
  const double frequency = kFourPi * stack.wave(number).q.real();
  const double least = std::max(film.thickness - kReachInSpreads * film.spread, 0.0);
  const double harmonics = reflection.harmonics(least);
  // The mean keeps no harmonic beyond these, unless the end of the distribution at thickness 0 keeps some of each.
  const double lasting = std::floor(kReachInSpreads / (frequency * film.spread));
  if (!ends_sharply(film, frequency) && lasting < harmonics && reflection.largest_ratio(least) < 1.0) {
    const int most = static_cast<int>(lasting);
    if (most == 0) return mean_over_thickness(film, 0.0, [&](double d) { return reflection.mean_over_phase(d); });
    return mean_over_thickness(film, lasting * frequency, [&](double d) { return reflection.at(d, most); });
  }
  // At thickness 0 the step must resolve a decay, too.
  const double fastest = !is_cut(film) ? frequency : kFourPi * std::abs(stack.wave(number).q);
  return mean_over_thickness(film, harmonics * fastest, [&](double d) { return reflection.at(d); });
}

}  // namespace

FilmReflection film_reflection(const FacetOptics& optics, double cosine) {
  Stack stack(optics, cosine);
  std::vector<std::size_t> varied;
  for (std::size_t j = 0; j < optics.films.size(); ++j)
    if (optics.films[j].spread > 0.0) varied.push_back(j);
  if (varied.empty()) return stack.reflection();
  if (varied.size() == 1) return film_mean(stack, optics.films[varied[0]], varied[0]);
  const auto [outer, inner] = std::pair(varied[0], varied[1]);
  const Film& film = optics.films[outer];
  const double least = std::max(0.0, film.thickness - kReachInSpreads * film.spread);
  const double most = kFourPi * stack.wave(outer).q.real() * FilmSeries(stack, outer).harmonics(least);
  return mean_over_thickness(film, most, [&](double d) {
    stack.thickness[outer] = d;
    return film_mean(stack, optics.films[inner], inner);
  });
}

SmoothAbsorptance film_absorptance(const FacetOptics& optics, double cosine) {
  // With a spread, absorptance / cosine is a straight line in the cosine below kGrazing. Above, 1 - R has enough
  // digits.
  constexpr double kGrazing = 1e-6;
  if (std::ranges::none_of(optics.films, [](const Film& film) { return film.spread > 0.0; }))
    return Stack(optics, cosine).absorptance();
  const auto difference = [&](double at) {
    const FilmReflection r = film_reflection(optics, at);
    return SmoothAbsorptance{std::max(1.0 - r.r_s, 0.0), std::max(1.0 - r.r_p, 0.0), kFilmRounding};
  };
  if (cosine >= kGrazing) return difference(cosine);
  const SmoothAbsorptance near = difference(kGrazing), far = difference(2.0 * kGrazing);
  const double share = cosine / kGrazing;
  SmoothAbsorptance absorbed{0.0, 0.0, 4.0 * share * kFilmRounding};
  const auto extrapolated = [&](double at, double beyond) {
    const double bend = 0.5 * beyond - at;
    if (at > 0.0) absorbed.error = std::max(absorbed.error, share * (4.0 * kFilmRounding + 4.0 * bend * bend / at));
    return std::max(share * (at + (share - 1.0) * bend), 0.0);
  };
  absorbed.s = extrapolated(near.s, far.s);
  absorbed.p = extrapolated(near.p, far.p);
  return absorbed;
}

bool is_too_wide(const Film& film) {
  constexpr double kMostWavelengths = 80.0;  // optical thickness; a mean then takes some 16,000 points
  return film.spread > 0.0 && is_cut(film) &&
         film.index.n * (film.thickness + kReachInSpreads * film.spread) > kMostWavelengths;
}

bool is_blurred(const Film& film) {
  const double least_frequency = kFourPi * wave_in(film.index, 0.0).q.real();
  return least_frequency * film.spread >= kReachInSpreads;
}

double fringe_count(const FacetOptics& optics) {
  double fringes = 0.0;
  for (const Film& film : optics.films) {
    if (is_blurred(film)) continue;
    const double normal = wave_in(film.index, 1.0).q.real();
    const double grazing = wave_in(film.index, 0.0).q.real();
    fringes += 2.0 * film.thickness * (normal - grazing);
  }
  return fringes;
}

}  // namespace dolp
