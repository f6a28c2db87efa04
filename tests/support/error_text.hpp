// Messages of exceptions.
#pragma once

#include <dolp/errors.hpp>
#include <string>

namespace dolp {

/// The message of the exception of type Error that a call throws.
template <class Error = InputError, class Call>
std::string error_text(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace dolp
