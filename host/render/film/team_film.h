#pragma once

#include "host/base/team.h"
#include "host/render/film/device_film.h"

namespace reradiant {

/// The film of the leader takes in those of all members, which become zero. Sums are added in
/// double and kept with what a float leaves of them in their compensation, so that doing this often
/// loses nothing.
void add_films(DeviceFilm& film, const FilmLayout& layout, Team& team);

} // namespace reradiant
