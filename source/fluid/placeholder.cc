namespace tanktread {}
