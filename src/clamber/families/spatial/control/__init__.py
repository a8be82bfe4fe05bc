"""What a robot in space is believed to be by its laws."""
