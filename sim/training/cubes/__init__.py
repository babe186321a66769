"""Lettered and coloured cubes on a floor, seen by a drone: the scenes, labelled pictures and measures of GridMask."""
