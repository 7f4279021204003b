// Elements of SVG that plots are made of. Numbers have two decimals, so that equal plots give equal text.
#pragma once

#include <string>

namespace vpe::report {

// Escapes "&", "<", ">" and quotes for HTML and XML.
std::string escape_markup(const std::string& text);
// Returns a number as text.
std::string svg_number(double value);
// Returns an attribute with a leading blank: ` x="1.50"`.
std::string svg_attribute(const char* name, double value);
// Returns a line of text with its anchor: start, middle or end. `more` has further attributes, with a leading blank.
std::string svg_text(double x, double y, const char* anchor, const std::string& text,
                     const std::string& more = "");
// Returns a straight line. `style` has its attributes, with a leading blank.
std::string svg_line(double x0, double y0, double x1, double y1, const std::string& style);
// Returns the beginning of a picture: its size, its fonts, a title for readers of screens, and more about it if that is not
// empty. "</svg>" ends it.
std::string svg_begin(int width_px, int height_px, const std::string& title, const std::string& about = "");
// Returns the text of a file of such a picture: black on white, on any background.
std::string svg_file(std::string svg);

}  // namespace vpe::report
