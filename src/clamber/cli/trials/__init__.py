"""`clamber trials`: climbs and walks carried out many times under noise."""
