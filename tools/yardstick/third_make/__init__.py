"""Field logs of a third make of machine: MuJoCo's bodies, and every law around them written here.

What a diagnosis is examined on must share no code with it. The foreign plants of the bench have
laws of their own on the bench's rigid bodies; here the bodies are another engine's as well.
"""
