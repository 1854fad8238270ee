// Commands and their options. command.cpp is the only code that uses CLI11.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/cli/options/choice.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spectile::cli {

/// An option that has been added to a command. Each member returns the option again.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required() const;
  /// The help shows the value that the option has now.
  Option show_default() const;
  Option type(const std::string& name) const;
  Option group(const std::string& name) const;
  /// Accepted, but not in the help: an old name.
  Option hidden() const;
  /// Numbers from `low` to `high`.
  Option range(double low, double high) const;
  /// Numbers that are not negative.
  Option not_negative() const;
  Option one_of(const std::vector<std::string>& names) const;
  /// Exactly two values, which the help calls `text`.
  Option pair(const std::string& text) const;
  /// Several values in one argument.
  Option separated_by(char separator) const;
  /// One value each time the option is given.
  Option one_value() const;
  Option excludes(const Option& other) const;
  /// The same, by its flag.
  Option excludes(const char* flag) const;
  /// `error` returns what is wrong with a value, or an empty text.
  Option check(std::function<std::string(const std::string&)> error) const;

 private:
  CLI::Option* option_;
};

/// A command to which options and subcommands are added. A handle: copies are the same command.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// A value that is given without a flag.
  template <class T>
  Option positional(const char* name, T& target, const std::string& text, const char* type = "FILE") const;

  /// An option whose value the help calls `type`.
  template <class T>
  Option option(const char* flags, T& target, const char* type, const char* group,
                const std::string& text) const;

  /// A file to write. Its name is neither empty nor "-".
  Option output_file(const char* flags, std::string& target, const char* group, const std::string& text,
                     const char* type = "FILE") const;

  Option flag(const char* flags, bool& target, const char* group, const std::string& text) const;

  /// An option that sets `target`, a T or an optional one. `choices` must outlive the command. The help shows
  /// the value that a T has now.
  template <class Target, class T, std::size_t kCount>
  Option choice(const char* flags, Target& target, const Choice<T> (&choices)[kCount], const char* group,
                const std::string& text) const {
    std::string shown;
    if constexpr (std::is_same_v<Target, T>) shown = name_of(choices, target);
    return named(
        flags, [&target, &choices](const std::string& name) { target = find_choice(choices, name)->value; },
        [&choices](const std::string& name) {
          return find_choice(choices, name) != nullptr ? std::string() : name + " not in " + list_of(choices);
        },
        shown, group, text);
  }

  Command subcommand(const char* name, const char* about) const;
  /// One subcommand must be given.
  void require_subcommand() const;
  /// Called when the command line names this command and is right.
  void on_run(std::function<void()> run) const;
  /// Text that ends the help.
  void footer(const std::string& text) const;
  /// Adds --help anew, as the last option, in a group.
  void help_group(const char* group) const;

 private:
  Option named(const char* flags, std::function<void(const std::string&)> set,
               std::function<std::string(const std::string&)> error, const std::string& shown,
               const char* group, const std::string& text) const;
  CLI::App* app_;
};

/// Adds a subcommand with arguments of its own, with which it runs; its exit code goes to `exit`.
template <class Arguments>
std::pair<Command, std::shared_ptr<Arguments>> add_subcommand(const Command& parent, const char* name,
                                                              const char* about, int (*run)(const Arguments&),
                                                              int& exit) {
  auto arguments = std::make_shared<Arguments>();
  const Command command = parent.subcommand(name, about);
  command.on_run([arguments, run, &exit] { exit = run(*arguments); });
  return {command, std::move(arguments)};
}

/// Wrong usage that a command finds when it runs. The message is printed as that of any wrong usage.
[[noreturn]] void throw_usage_error(const std::string& message);

/// The tool's command line.
class CommandLine {
 public:
  CommandLine(const char* name, const char* about, const char* version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  Command root() const { return Command(app_.get()); }
  /// Parses the arguments and runs the command that they name. The exit code where no command ran: the help,
  /// or wrong usage, which has been printed.
  std::optional<int> run(int argc, char** argv) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace spectile::cli
