"""Recordings of play in a file: a PNG picture, a GIF or an MP4 film with sound."""
