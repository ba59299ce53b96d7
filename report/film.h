#pragma once

#include <chrono>
#include <filesystem>

/// The cracking of the tests as a film, from the viewer of the page.
namespace feldspar
{
/// Throws InputError where there is no Chromium, which makes the film.
void check_film_is_possible();

/// Writes the film of the first specimens that a page shows, as animated WebP. The page is opened by Chromium with the
/// fragment #film (report/page/page.js), in which it draws the film and writes it down as text. Throws InputError where the
/// page shows no specimens, or Chromium does not end within `longest`.
void write_film(const std::filesystem::path& page, const std::filesystem::path& file,
                std::chrono::milliseconds longest = std::chrono::minutes(10));
} // namespace feldspar
