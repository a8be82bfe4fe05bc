"""The limbed climber a second time: read from docs/model.md alone, one scalar at a time, with no kernel in sight.

It is the oracle that the compiled kernel is tested against, so it imports nothing that computes from `clamber`.
"""
