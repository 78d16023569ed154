return { life = 42 }
