"""The viewer in a browser: how fast it draws, and the pictures of the documentation."""
