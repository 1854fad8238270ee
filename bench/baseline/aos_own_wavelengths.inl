// Part of aos_baseline_levels.cpp: colours at four wavelengths of their own, one after the other.

using FourSamples = SampledSpectrum<4>;

/// Four wavelengths' places between the centres of the bands.
struct Places {
  int band[4];
  float part[4];
};

Places places(const AosTables& t, const float* lambda_nm) {
  Places out;
  for (int k = 0; k < 4; ++k) {
    const float at = (lambda_nm[k] - t.first_centre_nm) * t.per_nm;
    const float held = at < 0 ? 0 : at > kSamples - 1 ? kSamples - 1 : at;
    out.band[k] = held < kSamples - 2 ? static_cast<int>(held) : kSamples - 2;
    out.part[k] = held - static_cast<float>(out.band[k]);
  }
  return out;
}

FourSamples sampled(const float* values, const Places& at) {
  FourSamples out;
  for (int k = 0; k < 4; ++k) {
    const float* const v = values + at.band[k];
    out.c[k] = v[0] + at.part[k] * (v[1] - v[0]);
  }
  return out;
}

/// The basis spectra that the colour is of, sampled and added up, by a branch on the order of its components.
void mixture_at(const AosTables& t, const float* in, float* out, std::size_t n) {
  enum { kWhite, kCyan, kMagenta, kYellow, kRed, kGreen, kBlue };
  for (std::size_t i = 0; i < n; ++i, in += 7, out += 4) {
    const Places at = places(t, in + 3);
    const float r = in[0];
    const float g = in[1];
    const float b = in[2];
    FourSamples sum{};
    const auto add = [&](float weight, int basis) { sum += sampled(t.basis[basis], at) * weight; };
    if (r <= g && r <= b) {
      add(r, kWhite);
      add((g <= b ? g : b) - r, kCyan);
      add(g <= b ? b - g : g - b, g <= b ? kBlue : kGreen);
    } else if (g <= r && g <= b) {
      add(g, kWhite);
      add((r <= b ? r : b) - g, kMagenta);
      add(r <= b ? b - r : r - b, r <= b ? kBlue : kRed);
    } else {
      add(b, kWhite);
      add((r <= g ? r : g) - b, kYellow);
      add(r <= g ? g - r : r - g, r <= g ? kGreen : kRed);
    }
    *reinterpret_cast<FourSamples*>(out) = sum.clamped();
  }
}

/// The same by an index, in one loop.
void mixture_at_fused(const AosTables& t, const float* in, float* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 7, out += 4) {
    int least = 0;
    int most = 0;
    for (int k = 1; k < 3; ++k) {
      if (in[k] < in[least]) least = k;
      if (in[k] > in[most]) most = k;
    }
    const float low = in[least];
    const float middle = least == most ? low : in[3 - least - most];
    const Places at = places(t, in + 3);
    const FourSamples white = sampled(t.basis[0], at);
    const FourSamples second = sampled(t.basis[1 + least], at);
    const FourSamples first = sampled(t.basis[4 + most], at);
    for (int k = 0; k < 4; ++k) {
      const float v = low * white.c[k] + (middle - low) * second.c[k] + (in[most] - middle) * first.c[k];
      out[k] = v < 0 ? 0 : v;
    }
  }
}

void sigmoids_at(const AosTables& /*tables*/, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 7, out += 4) {
    for (int k = 0; k < 4; ++k) {
      const float nm = in[3 + k] < 400 ? 400 : in[3 + k] > 700 ? 700 : in[3 + k];
      out[k] = sigmoid(in, (nm - 550) / 150);
    }
  }
}

/// The four texels around a point of a texture in memory that repeats, and their weights.
struct Footprint {
  const float* texel[4];
  float weight[4];
};

Footprint footprint(const AosTables& t, float u, float v) {
  const int side = t.texture_side;
  const auto place = [side](float c, int& first, int& second) {
    const float x = (c - std::floor(c)) * static_cast<float>(side) - 0.5F;
    const float whole = std::floor(x);
    first = static_cast<int>(whole);
    second = first + 1 == side ? 0 : first + 1;
    if (first < 0) first += side;
    return x - whole;
  };
  int column[2];
  int line[2];
  const float dx = place(u, column[0], column[1]);
  const float dy = place(v, line[0], line[1]);
  Footprint out;
  for (int tap = 0; tap < 4; ++tap) {
    out.texel[tap] = t.texels + 3 * (line[tap / 2] * side + column[tap % 2]);
    out.weight[tap] = (tap % 2 == 0 ? 1 - dx : dx) * (tap / 2 == 0 ? 1 - dy : dy);
  }
  return out;
}

/// The mean of the spectra of four texels.
void texture_of_colors(const AosTables& t, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 6, out += 4) {
    const Footprint at = footprint(t, in[0], in[1]);
    FourSamples sum{};
    for (int tap = 0; tap < 4; ++tap) {
      float color[7];
      for (int k = 0; k < 3; ++k) color[k] = at.texel[tap][k];
      for (int k = 0; k < 4; ++k) color[3 + k] = in[2 + k];
      FourSamples one;
      mixture_at(t, color, one.c, 1);
      sum += one * at.weight[tap];
    }
    *reinterpret_cast<FourSamples*>(out) = sum;
  }
}

/// The same by the weights of the basis spectra, which are filtered; then one spectrum.
void texture_of_colors_fused(const AosTables& t, const float* in, float* __restrict out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 6, out += 4) {
    const Footprint at = footprint(t, in[0], in[1]);
    float weights[7] = {};
    for (int tap = 0; tap < 4; ++tap) {
      const float* const c = at.texel[tap];
      int least = 0;
      int most = 0;
      for (int k = 1; k < 3; ++k) {
        if (c[k] < c[least]) least = k;
        if (c[k] > c[most]) most = k;
      }
      const float low = c[least];
      const float middle = least == most ? low : c[3 - least - most];
      weights[0] += at.weight[tap] * low;
      weights[1 + least] += at.weight[tap] * (middle - low);
      weights[4 + most] += at.weight[tap] * (c[most] - middle);
    }
    const Places places_of = places(t, in + 2);
    float sum[4] = {};
    for (int basis = 0; basis < 7; ++basis) {
      const FourSamples samples = sampled(t.basis[basis], places_of);
      for (int k = 0; k < 4; ++k) sum[k] += weights[basis] * samples.c[k];
    }
    for (int k = 0; k < 4; ++k) out[k] = sum[k] < 0 ? 0 : sum[k];
  }
}

void texture_of_sigmoids(const AosTables& t, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 6, out += 4) {
    const Footprint at = footprint(t, in[0], in[1]);
    FourSamples sum{};
    for (int tap = 0; tap < 4; ++tap) {
      FourSamples one;
      for (int k = 0; k < 4; ++k) {
        const float nm = in[2 + k] < 402.5F ? 402.5F : in[2 + k] > 697.5F ? 697.5F : in[2 + k];
        one.c[k] = sigmoid(at.texel[tap], (nm - 550) / 150);
      }
      sum += one * at.weight[tap];
    }
    *reinterpret_cast<FourSamples*>(out) = sum;
  }
}

/// A bounce and Russian roulette: throughput and scattering of four samples, a density, a random number.
void update_throughput(const AosTables& /*tables*/, const float* in, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i, in += 10, out += 4) {
    FourSamples beta = load<4>(in) * load<4>(in + 4);
    beta = beta * (1 / in[8]);
    float most = beta.c[0];
    for (int k = 1; k < 4; ++k) most = most < beta.c[k] ? beta.c[k] : most;
    const float survival = most > 1 ? 1 : most;
    *reinterpret_cast<FourSamples*>(out) = beta * (in[9] < survival ? 1 / survival : 0);
  }
}
