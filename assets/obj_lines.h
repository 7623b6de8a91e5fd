// An OBJ file's text, handed to tinyobjloader one checked line at a time.
//
// tinyobjloader reads what is no number as 0 and knows no line numbers in its callbacks, so this stream looks at each line
// first: it joins continued lines, lets through only vertices, faces and usemtl, and stops at the first bad one.
#pragma once

#include <cstddef>
#include <streambuf>
#include <string>
#include <vector>

#include "assets/vector.h"

namespace assets {

class ObjLines : public std::streambuf {
 public:
  explicit ObjLines(std::string text) : text_(std::move(text)) {}

  std::size_t line() const { return line_; }                                // of the statement last handed out
  const std::string& error() const { return error_; }                       // not empty: reading stopped at line()
  const std::vector<std::string>& libraries() const { return libraries_; }  // what stands behind each mtllib
  bool flat() const { return flat_; }                                       // "s off" holds
  bool other_surfaces() const { return other_surfaces_; }  // there are curves or free-form surfaces, which were skipped
  const std::string& odd_number() const { return odd_number_; }  // a number with letters behind it; empty: none
  std::size_t odd_number_line() const { return odd_number_line_; }

  // Colours behind the coordinates of "v": one a vertex from the first coloured one on, white before.
  const std::vector<Rgb>& colours() const { return colours_; }

 protected:
  int_type underflow() override;

 private:
  bool next_statement();
  bool accept();
  bool check_numbers(std::size_t least, std::size_t most);
  bool check_corners();

  std::string text_;
  std::size_t at_ = 0;
  std::size_t line_ = 0, next_line_ = 1;
  std::string statement_;
  std::vector<std::string> words_;
  std::string error_;
  std::string odd_number_;
  std::size_t odd_number_line_ = 0;
  std::size_t vertices_ = 0;
  std::vector<Rgb> colours_;
  std::vector<std::string> libraries_;
  bool flat_ = false;
  bool other_surfaces_ = false;
};

}  // namespace assets
