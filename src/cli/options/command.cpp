// Commands and their options, by CLI11.
#include "src/cli/options/command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "src/cli/options/nearest.hpp"
#include "src/cli/output/messages.hpp"

namespace spectile::cli {
namespace {

/// "film merge"; empty for the tool itself.
std::string path_of(const CLI::App& app) {
  const CLI::App* const parent = app.get_parent();
  if (parent == nullptr) return {};
  const std::string above = path_of(*parent);
  return above.empty() ? app.get_name() : above + " " + app.get_name();
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
  }
  return out;
}

/// The command that arguments name, and the first argument that it does not know.
struct Diagnosis {
  std::string command;
  std::string unknown = {};  ///< a sentence; empty where all are known
  std::string hidden = {};   ///< the first option whose name CLI11 leaves out of its errors
};

Diagnosis diagnose(const CLI::App& root, int argc, const char* const* argv) {
  const CLI::App* app = &root;
  Diagnosis out;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    const bool is_long = word.starts_with("--");
    if (is_long ||
        (word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0)) {
      const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
      const CLI::Option* const option = app->get_option_no_throw(name);
      if (option == nullptr) {
        return {path_of(*app),
                fmt::format("unknown option {}{}", name, suggestion(name, option_names(*app)))};
      }
      if (option->get_group().empty() && out.hidden.empty()) out.hidden = name;
      // Its values may look like anything.
      if (name == word) i += option->get_items_expected_min();
      continue;
    }
    std::vector<std::string> names;
    const CLI::App* found = nullptr;
    for (const CLI::App* sub : app->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(sub->get_name());
      if (sub->get_name() == word) found = sub;
    }
    if (names.empty()) continue;
    if (found == nullptr) {
      const std::string meant = suggestion(word, names);
      return {path_of(*app),
              fmt::format("unknown command \"{}\"{}", word,
                          meant.empty() ? fmt::format("; there are {}", fmt::join(names, ", ")) : meant)};
    }
    app = found;
  }
  out.command = path_of(*app);
  return out;
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::show_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::type(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::group(const std::string& name) const {
  option_->group(name);
  return *this;
}

Option Option::hidden() const {
  option_->group("");
  return *this;
}

Option Option::range(double low, double high) const {
  option_->check([low, high](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    return fmt::format("Value {} not in range {} to {}", text, low, high);
  });
  return *this;
}

Option Option::not_negative() const {
  const std::string type = option_->get_type_name();
  option_->check(CLI::NonNegativeNumber)->type_name(type);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& names) const {
  option_->check(CLI::IsMember(names).description(""));
  return *this;
}

Option Option::pair(const std::string& text) const {
  option_->expected(2)->option_text(text);
  return *this;
}

Option Option::separated_by(char separator) const {
  option_->delimiter(separator);
  return *this;
}

Option Option::one_value() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::excludes(const char* flag) const {
  option_->excludes(flag);
  return *this;
}

Option Option::check(std::function<std::string(const std::string&)> error) const {
  option_->check(std::move(error));
  return *this;
}

namespace {

/// The error of a file's name, to read or to write.
std::string empty_name(const std::string& name) {
  return name.empty() ? "the name of a file is empty" : "";
}

}  // namespace

template <class T>
Option Command::positional(const char* name, T& target, const std::string& text, const char* type) const {
  const Option added(app_->add_option(name, target, text)->type_name(type));
  return type == std::string_view("FILE") ? added.check(empty_name) : added;
}

template <class T>
Option Command::option(const char* flags, T& target, const char* type, const char* group,
                       const std::string& text) const {
  const Option added(app_->add_option(flags, target, text)->type_name(type)->group(group));
  return type == std::string_view("FILE") ? added.check(empty_name) : added;
}

// The types of options' targets: one more is one more line.
#define SPECTILE_OPTION_TARGET(T) \
  template Option Command::option<T>(const char*, T&, const char*, const char*, const std::string&) const
SPECTILE_OPTION_TARGET(std::string);
SPECTILE_OPTION_TARGET(std::optional<std::string>);
SPECTILE_OPTION_TARGET(std::vector<std::string>);
SPECTILE_OPTION_TARGET(int);
SPECTILE_OPTION_TARGET(std::int64_t);
SPECTILE_OPTION_TARGET(std::uint64_t);
SPECTILE_OPTION_TARGET(double);
SPECTILE_OPTION_TARGET(std::optional<float>);
SPECTILE_OPTION_TARGET(std::optional<double>);
SPECTILE_OPTION_TARGET(std::optional<int>);
SPECTILE_OPTION_TARGET(std::optional<std::size_t>);
SPECTILE_OPTION_TARGET(std::vector<int>);
SPECTILE_OPTION_TARGET(std::vector<double>);
#undef SPECTILE_OPTION_TARGET
template Option Command::positional<std::string>(const char*, std::string&, const std::string&,
                                                 const char*) const;
template Option Command::positional<std::optional<std::string>>(const char*, std::optional<std::string>&,
                                                                const std::string&, const char*) const;
template Option Command::positional<std::vector<std::string>>(const char*, std::vector<std::string>&,
                                                              const std::string&, const char*) const;

Option Command::output_file(const char* flags, std::string& target, const char* group,
                            const std::string& text, const char* type) const {
  return option(flags, target, type, group, text)
      .check(empty_name)
      .check([](const std::string& name) -> std::string {
        if (name == "-") return "- would be standard output, where no file is written; name a file";
        return {};
      });
}

Option Command::flag(const char* flags, bool& target, const char* group, const std::string& text) const {
  return Option(app_->add_flag(flags, target, text)->group(group));
}

Option Command::named(const char* flags, std::function<void(const std::string&)> set,
                      std::function<std::string(const std::string&)> error, const std::string& shown,
                      const char* group, const std::string& text) const {
  CLI::Option* const option = app_->add_option_function<std::string>(flags, std::move(set), text);
  option->type_name("NAME")->check(std::move(error))->group(group);
  if (!shown.empty()) option->default_str(shown);
  return Option(option);
}

Command Command::subcommand(const char* name, const char* about) const {
  return Command(app_->add_subcommand(name, about));
}

void Command::require_subcommand() const {
  app_->require_subcommand(1);
}

void Command::on_run(std::function<void()> run) const {
  app_->callback([app = app_, run = std::move(run)] {
    set_running_command(path_of(*app));
    run();
  });
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

void Command::help_group(const char* group) const {
  app_->set_help_flag("-h,--help", "Print this help message and exit")->group(group);
}

void throw_usage_error(const std::string& message) {
  throw CLI::ParseError(message, CLI::ExitCodes::RequiredError);
}

CommandLine::CommandLine(const char* name, const char* about, const char* version)
    : app_(std::make_unique<CLI::App>(about, name)) {
  app_->get_formatter()->column_width(34);
  app_->set_version_flag("--version", version);
}

CommandLine::~CommandLine() = default;

std::optional<int> CommandLine::run(int argc, char** argv) const {
  try {
    app_->parse(argc, argv);
    return {};
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);  // help or version
    const Diagnosis found = diagnose(*app_, argc, argv);
    set_running_command(found.command);
    std::string text = found.unknown.empty() ? error.what() : found.unknown;
    if (text.starts_with(": ")) text = found.hidden + text;
    for (char& c : text) c = c == '\n' ? ' ' : c;
    return complain_usage(text);
  }
}

}  // namespace spectile::cli
