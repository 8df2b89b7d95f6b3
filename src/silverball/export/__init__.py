"""Recordings of play as files: PNG pictures, GIF films, and MP4 films with sound."""
