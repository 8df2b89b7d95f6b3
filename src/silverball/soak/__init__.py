"""The soak: random play on random and hostile boards, checked after every tick, to find solver faults."""
