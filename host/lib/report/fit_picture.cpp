#include "report/fit_picture.hpp"

#include "base/python_picture.hpp"

namespace dolp {

void draw_fit(const std::string& json, const std::string& path) { draw_with_python(kFitPictureScript, json, path); }

}  // namespace dolp
