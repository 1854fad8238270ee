// Every command that reads tables of spectra says which guess it made: of units, values, columns and ends.
#include "tests/cli/guesses/guesses.hpp"

namespace spectile::test {
namespace {

class TableGuesses : public Guesses {
 protected:
  TableGuesses() {
    Picture grey = constant({"R", "G", "B"});
    write_scanlines(in_, grey);
    Picture bands = spectral({"T"});
    write_scanlines(spectral_, bands);
  }
  /// The commands that take a light, and the one that shows a spectrum.
  std::vector<Arguments> lights(const std::string& light) const {
    return {{"relight", in_, "-o", out_, "--illuminant", light},
            {"relight", in_, "-o", out_, "--illuminant", "A", "--white", light},
            {"project", spectral_, "-o", out_, "--illuminant", light},
            {"upsample", in_, "-o", out_, "--white", light},
            {"verify", in_, "--white", light},
            plan(light, {})};
  }
  std::vector<Arguments> reflectances(const std::string& table) const {
    return {plan("D65", {"--reflectances", table}),
            {"bench", "--only", "half to float", "--cache-only", "--quick", "--threads", "1",
             "--reflectances", table}};
  }
  std::string write(const std::string& text) const {
    write_text(table_, text);
    return table_;
  }

  const std::string spectral_ = folder_ / "spectral.exr";
  const std::string table_ = folder_ / "table.csv";
};

/// Values from 400 to 700 nm, wavelengths in this unit.
std::string rows(double per_nm, double per_value, const std::string& heading = {},
                 const char* separator = ",") {
  std::string out = heading;
  for (int nm = 400; nm <= 700; nm += 20)
    out += fmt::format("{}{}{}\n", nm * per_nm, separator, (0.25 + 0.001 * (nm - 400)) * per_value);
  return out;
}

struct TableGuess {
  std::string name;
  std::string text;
  std::vector<std::string> said;
  Arguments more = {};
  std::string column = {};
};

std::string wavenumbers() {
  std::string out = "wavenumber (cm^-1),value\n";
  for (int nm = 400; nm <= 700; nm += 20) out += fmt::format("{},{}\n", 1e7 / nm, 0.5);
  return out;
}

std::string decimal_commas() {
  std::string out = rows(1, 1, "", "\t");
  for (char& c : out) c = c == '.' ? ',' : c;
  return out;
}

TEST_F(TableGuesses, OfLightsAreSaidByEveryCommand) {
  const TableGuess guesses[] = {
      {"um, by the heading",
       rows(1e-3, 1, "wavelength (um),power\n"),
       {"wavelengths in um, as its heading says"}},
      {"um, by the numbers", rows(1e-3, 1), {"wavelengths taken as um, by their numbers, 0.4 to 0.7"}},
      {"m, by the numbers", rows(1e-9, 1), {"wavelengths taken as m, by their numbers"}},
      {"angstrom, by the numbers", rows(10, 1), {"wavelengths taken as angstrom, by their numbers"}},
      {"cm^-1",
       wavenumbers(),
       {"wavelengths in cm^-1, as its heading says", "values are taken as they are, not as per cm^-1"}},
      {"percent", rows(1, 100, "wavelength,power (%)\n"), {"values in percent, as the file says"}},
      {"missing sample", rows(1, 1) + "710,\n720,0.5\n", {"1 missing sample, left out"}},
      {"marked sample",
       rows(1, 1) + "710,-1.23e34\n720,0.5\n",
       {"1 missing sample"},
       {"--missing", "-1.23e34"}},
      {"decimal commas", decimal_commas(), {"numbers have decimal commas"}},
      {"a name that is a number too",
       "nm,1,0\n400,1,2\n550,1,2\n700,1,2\n",
       {"column 0 by its name; by number it is 1"},
       {},
       ":0"},
      {"a reflectance's heading",
       rows(1, 1, "wavelength,reflectance\n"),
       {"a heading says reflectance; taken as a light"}},
      {"dark noise", rows(1, 1) + "720,-0.001\n", {"1 of 17 values are below 0"}},
      {"rows",
       "name,400,450,500,550,600,650,700\nlamp,1,2,3,4,5,6,7\n",
       {"a spectrum in each row, wavelengths in the first"}},
      {"held", rows(1, 1), {"held beyond its ends"}, {"--ends", "held"}}};
  for (const TableGuess& guess : guesses) {
    const std::string light = write(guess.text) + guess.column;
    for (Arguments command : lights(light)) {
      command.insert(command.end(), guess.more.begin(), guess.more.end());
      expect_said(guess.name, command, guess.said);
    }
  }
  // As a white it has no spectra for the corners of RGB.
  const std::vector<Arguments> responses = lights("canon-eos-5d-mkii-r");
  for (const std::size_t i : {0U, 2U, 5U})
    expect_said("a response", responses[i], {"is a spectrum of kind camera response; taken as a light"});
  expect_silence(lights(table_)[0]);
}

TEST_F(TableGuesses, AreSaidWhereASpectrumIsShown) {
  for (const auto& [text, words] :
       {std::pair{rows(1e-3, 1, "wavelength (um),power\n"), "wavelengths in um, as its heading says"},
        {rows(1e-3, 1), "wavelengths taken as um, by their numbers"},
        {rows(1, 100, "wavelength,reflectance (%)\n"), "values in percent, as the file says"},
        {rows(1, 1) + "710,\n720,0.5\n", "1 missing sample, left out"}}) {
    expect_said("spectra", {"spectra", write(text)}, {words});
  }
}

TEST_F(TableGuesses, OfReflectancesAreSaidByEveryCommand) {
  const TableGuess guesses[] = {
      {"um, by the heading",
       rows(1e-3, 1, "wavelength (um),a\n"),
       {"wavelengths in um, as its heading says"}},
      {"um, by the numbers", rows(1e-3, 1), {"wavelengths taken as um, by their numbers"}},
      {"percent", rows(1, 100, "wavelength,reflectance (%)\n"), {"values in percent, as the file says"}},
      {"missing sample", rows(1, 1) + "710,\n720,0.5\n", {"1 missing sample, left out"}},
      {"decimal commas", decimal_commas(), {"numbers have decimal commas"}},
      {"rows",
       "name,400,450,500,550,600,650,700\na,.1,.2,.3,.4,.5,.6,.7\nb,.7,.6,.5,.4,.3,.2,.1\n",
       {"a spectrum in each row, wavelengths in the first"}}};
  for (const TableGuess& guess : guesses) {
    for (const Arguments& command : reflectances(write(guess.text)))
      expect_said(guess.name, command, guess.said);
  }
  Arguments plan = reflectances(write(rows(1, 255)))[0];
  plan.insert(plan.end(), {"--values", "255"});
  expect_said("counts", plan, {"values divided by 255"});
  plan = reflectances(write(rows(1, 1)))[0];
  plan.insert(plan.end(), {"--reflectance-ends", "zero"});
  expect_said("ends", plan, {"0 beyond its ends"});
}

}  // namespace
}  // namespace spectile::test
