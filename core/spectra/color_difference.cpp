// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/color_difference.h"

#include <cmath>
#include <numbers>

namespace spectrace {

namespace {

double cos_deg(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }
double sin_deg(double degrees) { return std::sin(degrees * std::numbers::pi / 180); }
double power7(double x) { return std::pow(x, 7); }

/// sqrt(C⁷ / (C⁷ + 25⁷)): how far a chroma is from grey.
double chroma_weight(double chroma) { return std::sqrt(power7(chroma) / (power7(chroma) + power7(25))); }

struct Polar {
  double lightness = 0, chroma = 0, hue_deg = 0;  // hue in [0, 360), 0 where chroma is 0
};

/// With a* stretched by `stretch`: eqs. 5 to 7.
Polar polar(const Xyz& lab, double stretch) {
  const double a = stretch * lab[1], b = lab[2];
  double hue = a == 0 && b == 0 ? 0 : std::atan2(b, a) * 180 / std::numbers::pi;
  if (hue < 0) hue += 360;
  return {lab[0], std::hypot(a, b), hue};
}

/// From the one hue to the other the short way round: eq. 10.
double hue_step(const Polar& from, const Polar& to) {
  if (from.chroma * to.chroma == 0) return 0;
  const double step = to.hue_deg - from.hue_deg;
  if (step > 180) return step - 360;
  return step < -180 ? step + 360 : step;
}

/// Half way the short way round: eq. 14.
double mean_hue(const Polar& x, const Polar& y) {
  const double sum = x.hue_deg + y.hue_deg;
  if (x.chroma * y.chroma == 0) return sum;
  if (std::abs(x.hue_deg - y.hue_deg) <= 180) return sum / 2;
  return sum < 360 ? sum / 2 + 180 : sum / 2 - 180;
}

}  // namespace

double ciede2000(const Xyz& lab1, const Xyz& lab2) {
  const double mean_ab = (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - chroma_weight(mean_ab));
  const Polar x = polar(lab1, stretch), y = polar(lab2, stretch);

  const double lightness = (x.lightness + y.lightness) / 2, chroma = (x.chroma + y.chroma) / 2,
               hue = mean_hue(x, y);
  const double t = 1 - 0.17 * cos_deg(hue - 30) + 0.24 * cos_deg(2 * hue) + 0.32 * cos_deg(3 * hue + 6) -
                   0.20 * cos_deg(4 * hue - 63);
  const double from_grey = (lightness - 50) * (lightness - 50);
  const double s_l = 1 + 0.015 * from_grey / std::sqrt(20 + from_grey);
  const double s_c = 1 + 0.045 * chroma, s_h = 1 + 0.015 * chroma * t;
  const double blue = std::exp(-((hue - 275) / 25) * ((hue - 275) / 25));
  const double rotation = -sin_deg(60 * blue) * 2 * chroma_weight(chroma);

  const double dl = (y.lightness - x.lightness) / s_l, dc = (y.chroma - x.chroma) / s_c;
  const double dh = 2 * std::sqrt(x.chroma * y.chroma) * sin_deg(hue_step(x, y) / 2) / s_h;
  return std::sqrt(dl * dl + dc * dc + dh * dh + rotation * dc * dh);
}

}  // namespace spectrace
