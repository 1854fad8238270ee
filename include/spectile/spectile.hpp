// Everything public.
#pragma once

#include <spectile/arithmetic.hpp>
#include <spectile/average.hpp>
#include <spectile/bands.hpp>
#include <spectile/color_difference.hpp>
#include <spectile/colorimetry.hpp>
#include <spectile/directions.hpp>
#include <spectile/image.hpp>
#include <spectile/irradiance.hpp>
#include <spectile/isa.hpp>
#include <spectile/measured_spectrum.hpp>
#include <spectile/named_spectra.hpp>
#include <spectile/radiometry.hpp>
#include <spectile/relight.hpp>
#include <spectile/representation.hpp>
#include <spectile/result.hpp>
#include <spectile/rgb_space.hpp>
#include <spectile/sampled_spectra.hpp>
#include <spectile/sensor.hpp>
#include <spectile/spectral_texture.hpp>
#include <spectile/spectrum.hpp>
#include <spectile/units.hpp>
#include <spectile/upsample.hpp>
#include <spectile/wavelengths.hpp>
