"""What exact search proves about the five boards of Bevly's thesis."""
