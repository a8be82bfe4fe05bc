"""Control laws: compiled functions of arrays, and the checked face around them. No clock and no simulator here."""
