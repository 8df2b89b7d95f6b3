"""Games: a world plus rules, with scores, replays and saved states; no window and no clock in here."""
