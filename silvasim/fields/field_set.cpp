#include "silvasim/fields/field_set.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <mutex>

#include "silvasim/base/error.h"
#include "silvasim/base/hash.h"
#include "silvasim/base/parallel.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/frame.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/raster_field.h"
#include "silvasim/fields/terrain.h"
#include "silvasim/fields/vector_field.h"

namespace silvasim::fields {

namespace {

using Settings = std::vector<config::FieldSettings>;

// The field that a derived one is made from. Errors: base::ConfigError.
std::size_t origin_of(const Settings& fields, const config::FieldSettings& derived) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].source == config::Source::derived) continue;
    if (derived.of.empty() ? fields[i].terrain : fields[i].name == derived.of) {
      if (fields[i].kind == config::FieldKind::class_code) {
        fail_at(derived, "\"" + fields[i].name + "\" holds class codes, from which nothing can be derived");
      }
      return i;
    }
    names.push_back(fields[i].name);
  }
  if (derived.of.empty()) fail_at(derived, "no field is the terrain; say terrain=\"true\" on one, or of=\"...\" here");
  fail_at(derived, "there is no raster or vector field \"" + derived.of + "\" to derive it from" +
                       base::did_you_mean(derived.of, names));
}

// How far beyond the scene each field must reach for what is derived from it.
std::vector<double> margins(const Settings& fields, const Frame& frame) {
  const double longer = std::max(frame.extent.width(), frame.extent.height());
  std::vector<double> margin(fields.size(), 0.0);
  for (const auto& field : fields) {
    if (field.source != config::Source::derived) continue;
    double& needed = margin[origin_of(fields, field)];
    needed = std::max(needed, needed_margin_m(field.derivation, field.radius_m, longer));
  }
  return margin;
}

Field load(const config::FieldSettings& settings, const Frame& frame, double margin_m) {
  Field field;
  RasterField loaded = settings.source == config::Source::raster ? load_raster_field(settings, frame, margin_m)
                                                                 : load_vector_field(settings, frame);
  field.raster = std::move(loaded.raster);
  field.source = std::move(loaded.source);
  field.path = settings.path;
  field.sha256 = base::sha256_of_file(settings.path);
  return field;
}

Field derive(const config::FieldSettings& settings, const Field& origin) {
  Field field;
  field.raster = derive(settings.derivation, origin.raster, settings.radius_m);
  field.source = "derived from \"" + origin.name + "\"";
  return field;
}

void name(Field& field, const config::FieldSettings& settings) {
  field.name = settings.name;
  field.kind = settings.kind;
  // Between 359 and 1 degree lies north, not south: angles are not interpolated.
  if (settings.source == config::Source::derived && settings.derivation == config::TerrainMeasure::aspect_deg) {
    field.kind = config::FieldKind::class_code;
  }
  field.no_data = settings.no_data;
  field.no_data_fill = static_cast<float>(settings.no_data_fill);
}

// Runs a task for each index on all threads. What goes wrong is gathered, so that the user reads every mistake at once.
void for_each_field(std::size_t count, const std::function<void(std::size_t)>& task) {
  std::vector<std::exception_ptr> problems(count);
  base::parallel_for(count, [&](std::size_t i) {
    try {
      task(i);
    } catch (...) {
      problems[i] = std::current_exception();
    }
  });
  std::vector<base::Diagnostic> diagnostics;
  std::exception_ptr other;
  for (const auto& problem : problems) {
    if (!problem) continue;
    try {
      std::rethrow_exception(problem);
    } catch (const base::Cancelled&) {
      throw;
    } catch (const base::ConfigError& error) {
      diagnostics.insert(diagnostics.end(), error.diagnostics().begin(), error.diagnostics().end());
    } catch (...) {
      if (!other) other = problem;
    }
  }
  if (!diagnostics.empty()) throw base::ConfigError(std::move(diagnostics));
  if (other) std::rethrow_exception(other);
}

}  // namespace

FieldSet load_fields(const config::SceneSettings& scene, const Settings& fields, const base::Progress& progress) {
  prepare_gdal();
  FieldSet set;
  set.frame = settle_frame(scene, fields);
  set.fields.resize(fields.size());
  const std::vector<double> margin = margins(fields, set.frame);

  std::mutex one_at_a_time;
  std::size_t done = 0;
  const auto finish = [&](std::size_t i) {
    name(set.fields[i], fields[i]);
    const std::lock_guard lock(one_at_a_time);
    base::report(progress, "fields", double(++done) / double(fields.size()));
  };

  // Read the files, each by one thread.
  for_each_field(fields.size(), [&](std::size_t i) {
    if (fields[i].source == config::Source::derived) return;
    set.fields[i] = load(fields[i], set.frame, margin[i]);
    finish(i);
  });
  // Then what is made from them.
  for_each_field(fields.size(), [&](std::size_t i) {
    if (fields[i].source != config::Source::derived) return;
    set.fields[i] = derive(fields[i], set.fields[origin_of(fields, fields[i])]);
    finish(i);
  });
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].terrain && fields[i].source != config::Source::derived) set.terrain = static_cast<int>(i);
  }
  return set;
}

}  // namespace silvasim::fields
