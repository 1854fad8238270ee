// Adding options to a command, those among them whose value is one of a few names.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace spectile::cli {

/// A name on the command line and its value. A second name of the same value is accepted and not listed.
template <class T>
struct Choice {
  const char* name;
  T value;
};

/// Entry of a name; null for other texts.
template <class T, std::size_t kCount>
const Choice<T>* find_choice(const Choice<T> (&choices)[kCount], const std::string& name) {
  for (const Choice<T>& choice : choices) {
    if (name == choice.name) return &choice;
  }
  return nullptr;
}

/// First name of a value.
template <class T, std::size_t kCount>
std::string name_of(const Choice<T> (&choices)[kCount], T value) {
  for (const Choice<T>& choice : choices) {
    if (choice.value == value) return choice.name;
  }
  return {};
}

/// "{a,b,c}".
template <class T, std::size_t kCount>
std::string list_of(const Choice<T> (&choices)[kCount]) {
  std::string out;
  for (const Choice<T>& choice : choices) {
    if (name_of(choices, choice.value) == choice.name)
      out += (out.empty() ? "{" : ",") + std::string(choice.name);
  }
  return out + "}";
}

/// Adds options to a command, each in a group of its help.
struct OptionAdder {
  CLI::App& command;

  /// An option whose value the help calls `type`.
  template <class Target>
  CLI::Option* operator()(const std::string& flag, Target& target, const char* type, const char* group,
                          const std::string& text) const {
    return command.add_option(flag, target, text)->type_name(type)->group(group);
  }

  CLI::Option* flag(const std::string& name, bool& target, const char* group, const std::string& text) const {
    return command.add_flag(name, target, text)->group(group);
  }

  /// An option that sets `target`, a T or an optional one. `choices` must outlive the command. The help shows
  /// the value that a T has now.
  template <class Target, class T, std::size_t kCount>
  CLI::Option* choice(const std::string& flag, Target& target, const Choice<T> (&choices)[kCount],
                      const char* group, const std::string& text) const {
    CLI::Option* const option = command.add_option_function<std::string>(
        flag, [&target, &choices](const std::string& name) { target = find_choice(choices, name)->value; },
        text);
    option->type_name("NAME")->check([&choices](const std::string& name) {
      return find_choice(choices, name) != nullptr ? std::string() : name + " not in " + list_of(choices);
    });
    if constexpr (std::is_same_v<Target, T>) option->default_str(name_of(choices, target));
    return option->group(group);
  }
};

/// Adds a subcommand with arguments of its own, with which it runs; its exit code goes to `exit`.
template <class Arguments>
std::pair<CLI::App*, std::shared_ptr<Arguments>> add_subcommand(CLI::App& parent, const char* name,
                                                                const char* about,
                                                                int (*run)(const Arguments&), int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = parent.add_subcommand(name, about);
  command->callback([arguments, run, &exit] { exit = run(*arguments); });
  return {command, std::move(arguments)};
}

}  // namespace spectile::cli
