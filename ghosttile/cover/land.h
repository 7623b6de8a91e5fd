// The land that rules are read over: its plants, its data fields, the time of the year.
//
// Sources that several rules ask for alike are made once.
// Threads: source() and make_rule() from one thread; what they return from any.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "ghosttile/cover/plants.h"
#include "ghosttile/cover/source.h"
#include "silvasim/fields/field_set.h"

namespace ghosttile::cover {

struct LandOptions {
  double month = 10.5;  // 1 to 13: 10.5 is the middle of October
  std::uint64_t seed = 1;
  std::size_t most_bytes_a_source = 32u << 20;  // of lattice blocks, 17 kB each
};

class Land {
 public:
  // `fields` may be null: there are no data fields then.
  Land(std::shared_ptr<const Plants> plants, std::shared_ptr<const silvasim::fields::FieldSet> fields,
       const LandOptions& options = {})
      : plants_(std::move(plants)), fields_(std::move(fields)), options_(options) {}

  const std::shared_ptr<const Plants>& plants() const { return plants_; }
  const std::shared_ptr<const silvasim::fields::FieldSet>& fields() const { return fields_; }
  const LandOptions& options() const { return options_; }

  // The source of that name, made by `make` if there is none yet. The name says all that the source depends on.
  std::shared_ptr<const Source> source(const std::string& name,
                                       const std::function<std::shared_ptr<const Source>()>& make) {
    std::shared_ptr<const Source>& known = sources_[name];
    if (!known) known = make();
    return known;
  }

 private:
  std::shared_ptr<const Plants> plants_;
  std::shared_ptr<const silvasim::fields::FieldSet> fields_;
  LandOptions options_;
  std::map<std::string, std::shared_ptr<const Source>> sources_;
};

}  // namespace ghosttile::cover
