//! What a contact is and what a law makes of it: the page a physicist reads.
