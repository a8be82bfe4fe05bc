"""Plans carried out by a simulated climber."""
