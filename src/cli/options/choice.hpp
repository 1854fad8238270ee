// Option values that are one of a few names.
#pragma once

#include <cstddef>
#include <string>

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

}  // namespace spectile::cli
