(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Fractions whose operations are cheap where denominators agree, lemmas on vectors, and what a direction separates. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems.
Import ListNotations.
Open Scope R_scope.

(* --- Fractions: all numbers of a file have one denominator, so that sums of like terms need no multiplication --- *)
Definition qadd (a b : Q) : Q := if Pos.eqb (Qden a) (Qden b) then Qmake (Qnum a + Qnum b) (Qden a) else Qplus a b.
Definition qopp (a : Q) : Q := Qmake (- Qnum a) (Qden a).
Definition qsub (a b : Q) : Q := qadd a (qopp b).
Definition qmul (a b : Q) : Q := Qmake (Qnum a * Qnum b) (Qden a * Qden b).
Definition qle (a b : Q) : bool := if Pos.eqb (Qden a) (Qden b) then Z.leb (Qnum a) (Qnum b) else Qle_bool a b.
Definition qlt (a b : Q) : bool := negb (qle b a).
Definition qeq (a b : Q) : bool := qle a b && qle b a.
Definition qmin (a b : Q) : Q := if qle a b then a else b.
Definition qmax (a b : Q) : Q := if qle a b then b else a.

Lemma Q2R_add a b : Q2R (qadd a b) = Q2R a + Q2R b.
Proof.
  rewrite <- Q2R_plus. apply Qeq_eqR. unfold qadd. destruct (Pos.eqb_spec (Qden a) (Qden b)) as [e|_]; [|reflexivity].
  destruct a as [x d], b as [y d']; simpl in e; subst d'. unfold Qeq, Qplus; simpl. rewrite Pos2Z.inj_mul. ring.
Qed.
Lemma Q2R_neg a : Q2R (qopp a) = - Q2R a.  Proof. apply Q2R_opp. Qed.
Lemma Q2R_sub a b : Q2R (qsub a b) = Q2R a - Q2R b.
Proof. unfold qsub. now rewrite Q2R_add, Q2R_neg. Qed.
Lemma Q2R_mul a b : Q2R (qmul a b) = Q2R a * Q2R b.  Proof. apply Q2R_mult. Qed.

Lemma qle_iff a b : qle a b = true <-> Q2R a <= Q2R b.
Proof.
  assert (e : qle a b = Qle_bool a b).
  { unfold qle. destruct (Pos.eqb_spec (Qden a) (Qden b)) as [e|_]; [|reflexivity].
    destruct a as [x d], b as [y d']; simpl in e; subst d'. unfold Qle_bool; simpl.
    apply eq_true_iff_eq. rewrite !Z.leb_le. pose proof (Pos2Z.is_pos d). split; intros; nia. }
  rewrite e, Qle_bool_iff. split; [apply Qle_Rle|apply Rle_Qle].
Qed.
Lemma qle_R a b : qle a b = true -> Q2R a <= Q2R b.  Proof. apply qle_iff. Qed.
Lemma qlt_iff a b : qlt a b = true <-> Q2R a < Q2R b.
Proof.
  unfold qlt. rewrite negb_true_iff. destruct (qle b a) eqn:h.
  - apply qle_iff in h. split; [discriminate|lra].
  - split; [intros _|reflexivity]. apply Rnot_le_lt. intro l. apply qle_iff in l. congruence.
Qed.
Lemma qlt_R a b : qlt a b = true -> Q2R a < Q2R b.  Proof. apply qlt_iff. Qed.
Lemma qeq_R a b : qeq a b = true -> Q2R a = Q2R b.
Proof. unfold qeq. intro h. apply andb_true_iff in h. destruct h as [h k]. apply qle_R in h, k. lra. Qed.

Lemma Q2R_min a b : Q2R (qmin a b) = Rmin (Q2R a) (Q2R b).
Proof.
  unfold qmin. destruct (qle a b) eqn:h.
  - apply qle_R in h. now rewrite Rmin_left.
  - rewrite Rmin_right; [reflexivity|]. assert (l : qlt b a = true) by (unfold qlt; now rewrite h). apply qlt_R in l. lra.
Qed.
Lemma Q2R_max a b : Q2R (qmax a b) = Rmax (Q2R a) (Q2R b).
Proof.
  unfold qmax. destruct (qle a b) eqn:h.
  - apply qle_R in h. now rewrite Rmax_right.
  - rewrite Rmax_left; [reflexivity|]. assert (l : qlt b a = true) by (unfold qlt; now rewrite h). apply qlt_R in l. lra.
Qed.
Lemma Q2R_0 : Q2R 0 = 0.  Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_1 : Q2R 1 = 1.  Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_2 : Q2R 2 = 2.  Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_4 : Q2R 4 = 4.  Proof. unfold Q2R; simpl; lra. Qed.

(* --- Points --- *)
Definition psub (a b : point) : point := (qsub (fst a) (fst b), qsub (snd a) (snd b)).
Definition pdot (a b : point) : Q := qadd (qmul (fst a) (fst b)) (qmul (snd a) (snd b)).
Definition pcross (a b : point) : Q := qsub (qmul (fst a) (snd b)) (qmul (snd a) (fst b)).
Definition pturn (a : point) : point := (qopp (snd a), fst a).
Definition peq (a b : point) : bool := qeq (fst a) (fst b) && qeq (snd a) (snd b).
Definition cross (a b : vec) : R := fst a * snd b - snd a * fst b.

Lemma real_sub a b : real (psub a b) = sub (real a) (real b).
Proof. unfold psub, sub, real; simpl. now rewrite !Q2R_sub. Qed.
Lemma Q2R_dot a b : Q2R (pdot a b) = dot (real a) (real b).
Proof. unfold pdot, dot, real; simpl. now rewrite Q2R_add, !Q2R_mul. Qed.
Lemma Q2R_cross a b : Q2R (pcross a b) = cross (real a) (real b).
Proof. unfold pcross, cross, real; simpl. now rewrite Q2R_sub, !Q2R_mul. Qed.
Lemma peq_real a b : peq a b = true -> real a = real b.
Proof. unfold peq, real. intro h. apply andb_true_iff in h. destruct h as [h k]. apply qeq_R in h, k. now rewrite h, k. Qed.

(* Conjunctions of comparisons of fractions become comparisons of real numbers. *)
Ltac reals :=
  repeat match goal with
  | h : andb _ _ = true |- _ => apply andb_true_iff in h; destruct h
  | h : qle _ _ = true |- _ => apply qle_R in h
  | h : qlt _ _ = true |- _ => apply qlt_R in h
  | h : qeq _ _ = true |- _ => apply qeq_R in h
  end;
  repeat rewrite ?Q2R_add, ?Q2R_sub, ?Q2R_mul, ?Q2R_neg, ?Q2R_dot, ?Q2R_cross, ?real_sub, ?Q2R_0, ?Q2R_1, ?Q2R_2, ?Q2R_4 in *.

(* --- Vectors --- *)
Lemma dot_self a : 0 <= dot a a.  Proof. unfold dot. nra. Qed.
Lemma cauchy_schwarz a b : dot a b * dot a b <= dot a a * dot b b.
Proof. pose proof (Rle_0_sqr (cross a b)) as h. unfold Rsqr, cross in h. unfold dot. lra. Qed.
Lemma dot_mix n s x y : dot n (mix s x y) = (1 - s) * dot n x + s * dot n y.
Proof. unfold dot, mix, add, scale; simpl. ring. Qed.
Lemma dot_sub n x y : dot n (sub x y) = dot n x - dot n y.
Proof. unfold dot, sub; simpl. ring. Qed.
Lemma dot_add n x y : dot n (add x y) = dot n x + dot n y.
Proof. unfold dot, add; simpl. ring. Qed.
Lemma dot_scale n s x : dot n (scale s x) = s * dot n x.
Proof. unfold dot, scale; simpl. ring. Qed.

Lemma square_le a b : 0 <= b -> a * a <= b * b -> a <= b.
Proof. intros. destruct (Rle_or_lt a b); nra. Qed.

Lemma bounded_dot x y a b : 0 <= a -> 0 <= b -> dot x x <= a * a -> dot y y <= b * b -> dot x y <= a * b.
Proof.
  intros. apply square_le; [now apply Rmult_le_pos|]. apply Rle_trans with (1 := cauchy_schwarz x y).
  apply Rle_trans with (a * a * (b * b)); [|right; ring]. apply Rmult_le_compat; try assumption; apply dot_self.
Qed.

(* What lies beyond m in a direction n, with r |n| <= m, is at least r away. *)
Lemma far n x y r m : 0 < dot n n -> 0 <= m -> r * r * dot n n <= m * m -> m <= dot n (sub x y) -> apart r x y.
Proof.
  intros n0 m0 h k. unfold apart. apply Rmult_le_reg_r with (dot n n); [assumption|].
  apply Rle_trans with (1 := h). pose proof (cauchy_schwarz n (sub x y)). nra.
Qed.
Lemma apart_sym r x y : apart r x y -> apart r y x.
Proof. unfold apart, dot, sub; simpl. intro h. lra. Qed.
Lemma apart_less r s x y : 0 <= r <= s -> apart s x y -> apart r x y.
Proof. unfold apart. intros. nra. Qed.

(* --- Hulls --- *)
Lemma hull_above n c ps : (forall p, In p ps -> c <= dot n (real p)) -> forall x, hull ps x -> c <= dot n x.
Proof. intros h x hx. induction hx as [p hp|x y s _ ix _ iy hs]; [now apply h|]. rewrite dot_mix. nra. Qed.
Lemma hull_below n c ps : (forall p, In p ps -> dot n (real p) <= c) -> forall x, hull ps x -> dot n x <= c.
Proof. intros h x hx. induction hx as [p hp|x y s _ ix _ iy hs]; [now apply h|]. rewrite dot_mix. nra. Qed.

Lemma mix_mix s t q a b : mix q (mix s a b) (mix t a b) = mix ((1 - q) * s + q * t) a b.
Proof. unfold mix, add, scale; simpl. f_equal; ring. Qed.
Lemma mix_0 a b : mix 0 a b = a.  Proof. destruct a; unfold mix, add, scale; simpl. f_equal; ring. Qed.
Lemma mix_1 a b : mix 1 a b = b.  Proof. destruct b; unfold mix, add, scale; simpl. f_equal; ring. Qed.

Lemma on_mix a b x : on (a, b) x <-> exists s, 0 <= s <= 1 /\ x = mix s (real a) (real b).
Proof.
  unfold on; simpl. split.
  - intro h. induction h as [p hp|x y q _ ix _ iy hq].
    + destruct hp as [e|[e|[]]]; subst p; [exists 0; rewrite mix_0|exists 1; rewrite mix_1]; split; auto; lra.
    + destruct ix as [s [hs ex]], iy as [t [ht ey]]. exists ((1 - q) * s + q * t). split; [nra|]. subst. apply mix_mix.
  - intros [s [hs e]]. subst. apply chord; [apply corner; left|apply corner; right; left|]; auto.
Qed.
Lemma on_first e : on e (real (fst e)).  Proof. apply corner. now left. Qed.
Lemma on_second e : on e (real (snd e)).  Proof. apply corner. right. now left. Qed.

Lemma hull_convex ps qs x : (forall p, In p ps -> hull qs (real p)) -> hull ps x -> hull qs x.
Proof. intros h hx. induction hx; [now apply h|now apply chord]. Qed.

(* --- Separation: the values of n over each hull fill an interval; the gap between both is at least r |n| --- *)
Fixpoint lowest (n : point) (a : point) (ps : list point) : Q :=
  match ps with [] => pdot n a | b :: r => qmin (pdot n a) (lowest n b r) end.
Fixpoint highest (n : point) (a : point) (ps : list point) : Q :=
  match ps with [] => pdot n a | b :: r => qmax (pdot n a) (highest n b r) end.

Lemma lowest_ok n ps : forall a p, In p (a :: ps) -> Q2R (lowest n a ps) <= dot (real n) (real p).
Proof.
  induction ps as [|b r ih]; intros a p hp; simpl.
  - destruct hp as [e|[]]; subst. rewrite Q2R_dot. lra.
  - rewrite Q2R_min. destruct hp as [e|hp].
    + subst. rewrite Q2R_dot. apply Rmin_l.
    + apply Rle_trans with (1 := Rmin_r _ _). now apply ih.
Qed.
Lemma highest_ok n ps : forall a p, In p (a :: ps) -> dot (real n) (real p) <= Q2R (highest n a ps).
Proof.
  induction ps as [|b r ih]; intros a p hp; simpl.
  - destruct hp as [e|[]]; subst. rewrite Q2R_dot. lra.
  - rewrite Q2R_max. destruct hp as [e|hp].
    + subst. rewrite Q2R_dot. apply Rmax_l.
    + apply Rle_trans with (2 := Rmax_r _ _). now apply ih.
Qed.

(* rr: the square of the distance; a and b: the ends of two segments *)
Definition parted_by (rr : Q) (a b : edge) (n : point) : bool :=
  let a1 := pdot n (fst a) in let a2 := pdot n (snd a) in let b1 := pdot n (fst b) in let b2 := pdot n (snd b) in
  let m := qmax (qsub (qmin a1 a2) (qmax b1 b2)) (qsub (qmin b1 b2) (qmax a1 a2)) in
  qle 0 m && (let nn := pdot n n in qlt 0 nn && qle (qmul rr nn) (qmul m m)).

(* Their boxes are apart: mostly this decides. *)
Definition beside (r a1 a2 b1 b2 : Q) : bool :=
  qle (qadd (qmax a1 a2) r) (qmin b1 b2) || qle (qadd (qmax b1 b2) r) (qmin a1 a2).
Definition boxes_apart (r : Q) (a b : edge) : bool :=
  beside r (fst (fst a)) (fst (snd a)) (fst (fst b)) (fst (snd b)) || beside r (snd (fst a)) (snd (snd a)) (snd (fst b)) (snd (snd b)).

(* Of two segments that are r apart some direction of these is a witness: that of their shortest connection. *)
Definition fractions_apart (r : Q) (a b : edge) : bool :=
  qle 0 r && (boxes_apart r a b ||
    let by_ := parted_by (qmul r r) a b in
    by_ (pturn (psub (snd a) (fst a))) || by_ (pturn (psub (snd b) (fst b)))
    || by_ (psub (fst a) (fst b)) || by_ (psub (snd a) (snd b)) || by_ (psub (fst a) (snd b)) || by_ (psub (snd a) (fst b))).

(* The same in whole numbers, seen from the first end of a: where all denominators agree, nothing depends on them. *)
Definition zmin (a b : Z) : Z := if Z.leb a b then a else b.
Definition zmax (a b : Z) : Z := if Z.leb a b then b else a.
Definition whole_parted_by (rr ux uy cx cy dx dy nx ny : Z) : bool :=
  let a := (nx * ux + ny * uy)%Z in let b := (nx * cx + ny * cy)%Z in let c := (nx * dx + ny * dy)%Z in
  let m := zmax (zmin 0 a - zmax b c) (zmin b c - zmax 0 a) in
  Z.leb 0 m && (let nn := (nx * nx + ny * ny)%Z in negb (Z.leb nn 0) && Z.leb (rr * nn) (m * m)).
Definition whole_beside (r a b c : Z) : bool := Z.leb (zmax 0 a + r) (zmin b c) || Z.leb (zmax b c + r) (zmin 0 a).
Definition whole_apart (r ux uy cx cy dx dy : Z) : bool :=
  Z.leb 0 r && (whole_beside r ux cx dx || whole_beside r uy cy dy ||
    let rr := (r * r)%Z in
    whole_parted_by rr ux uy cx cy dx dy (- uy) ux || whole_parted_by rr ux uy cx cy dx dy (- (dy - cy)) (dx - cx)
    || whole_parted_by rr ux uy cx cy dx dy (- cx) (- cy) || whole_parted_by rr ux uy cx cy dx dy (ux - dx) (uy - dy)
    || whole_parted_by rr ux uy cx cy dx dy (- dx) (- dy) || whole_parted_by rr ux uy cx cy dx dy (ux - cx) (uy - cy)).

Definition in_units (d : positive) (p : point) : bool := Pos.eqb (Qden (fst p)) d && Pos.eqb (Qden (snd p)) d.
Definition units_apart (r : Q) (a b : edge) : bool :=
  let d := Qden r in
  if in_units d (fst a) && in_units d (snd a) && in_units d (fst b) && in_units d (snd b)
  then let x := Qnum (fst (fst a)) in let y := Qnum (snd (fst a)) in whole_apart (Qnum r) (Qnum (fst (snd a)) - x) (Qnum (snd (snd a)) - y)
    (Qnum (fst (fst b)) - x) (Qnum (snd (fst b)) - y) (Qnum (fst (snd b)) - x) (Qnum (snd (snd b)) - y)
  else fractions_apart r a b.

(* Numbers whose denominators divide the largest get that one. *)
Definition lift (d : positive) (a : Q) : Q :=
  if Pos.eqb (Qden a) d then a
  else let k := Z.div (Zpos d) (Zpos (Qden a)) in if Z.eqb (k * Zpos (Qden a)) (Zpos d) then Qmake (Qnum a * k) d else a.
Definition plift (d : positive) (p : point) : point := (lift d (fst p), lift d (snd p)).
Definition finer (a b : positive) : positive := if Pos.eqb a b then a else if Z.leb (Zpos a) (Zpos b) then b else a.
Definition finest (a : edge) : positive := finer (finer (Qden (fst (fst a))) (Qden (snd (fst a)))) (finer (Qden (fst (snd a))) (Qden (snd (snd a)))).
Definition segments_apart (r : Q) (a b : edge) : bool :=
  let d := finer (Qden r) (finer (finest a) (finest b)) in
  units_apart (lift d r) (plift d (fst a), plift d (snd a)) (plift d (fst b), plift d (snd b)).

(* Boxes in whole numbers of 1/d, rounded outward: of most pairs of a route's pieces and edges they decide. *)
Record outer := { low_x : Z; high_x : Z; low_y : Z; high_y : Z }.
Definition down (d : positive) (a : Q) : Z := if Pos.eqb (Qden a) d then Qnum a else Z.div (Qnum a * Zpos d) (Zpos (Qden a)).
Definition up (d : positive) (a : Q) : Z := (- down d (qopp a))%Z.
Definition outer_of (d : positive) (e : edge) : outer :=
  {| low_x := zmin (down d (fst (fst e))) (down d (fst (snd e))); high_x := zmax (up d (fst (fst e))) (up d (fst (snd e)));
     low_y := zmin (down d (snd (fst e))) (down d (snd (snd e))); high_y := zmax (up d (snd (fst e))) (up d (snd (snd e))) |}.
Definition outers_apart (r : Z) (a b : outer) : bool :=
  Z.leb (high_x a + r) (low_x b) || Z.leb (high_x b + r) (low_x a) || Z.leb (high_y a + r) (low_y b) || Z.leb (high_y b + r) (low_y a).

Lemma parted_by_ok r a b n : parted_by (qmul r r) a b n = true -> forall x y, on a x -> on b y -> apart (Q2R r) x y.
Proof.
  unfold parted_by. intros h x y hx hy. apply andb_true_iff in h; destruct h as [h2 h]. apply andb_true_iff in h; destruct h as [h1 h3].
  set (a1 := pdot n (fst a)) in *. set (a2 := pdot n (snd a)) in *. set (b1 := pdot n (fst b)) in *. set (b2 := pdot n (snd b)) in *.
  assert (xa : Q2R (qmin a1 a2) <= dot (real n) x <= Q2R (qmax a1 a2)).
  { rewrite Q2R_min, Q2R_max. unfold a1, a2. rewrite !Q2R_dot. split.
    - apply hull_above with (2 := hx). intros p [e|[e|[]]]; subst; [apply Rmin_l|apply Rmin_r].
    - apply hull_below with (2 := hx). intros p [e|[e|[]]]; subst; [apply Rmax_l|apply Rmax_r]. }
  assert (yb : Q2R (qmin b1 b2) <= dot (real n) y <= Q2R (qmax b1 b2)).
  { rewrite Q2R_min, Q2R_max. unfold b1, b2. rewrite !Q2R_dot. split.
    - apply hull_above with (2 := hy). intros p [e|[e|[]]]; subst; [apply Rmin_l|apply Rmin_r].
    - apply hull_below with (2 := hy). intros p [e|[e|[]]]; subst; [apply Rmax_l|apply Rmax_r]. }
  apply qlt_R in h1. apply qle_R in h2, h3. rewrite Q2R_0, Q2R_dot in h1. rewrite Q2R_0 in h2. rewrite !Q2R_mul, Q2R_dot in h3.
  rewrite Q2R_max, !Q2R_sub in h2, h3.
  destruct (Rle_or_lt (Q2R (qmin b1 b2) - Q2R (qmax a1 a2)) (Q2R (qmin a1 a2) - Q2R (qmax b1 b2))) as [l|l].
  - rewrite Rmax_left in h2, h3 by lra. eapply far; [exact h1|exact h2|exact h3|]. rewrite dot_sub. lra.
  - rewrite Rmax_right in h2, h3 by lra. apply apart_sym. eapply far; [exact h1|exact h2|exact h3|]. rewrite dot_sub. lra.
Qed.

Lemma beside_ok r (f : point -> Q) (g : vec -> R) a b x y : 0 <= Q2R r -> (forall p, g (real p) = Q2R (f p)) ->
  (forall s u v, g (mix s u v) = (1 - s) * g u + s * g v) -> on a x -> on b y ->
  beside r (f (fst a)) (f (snd a)) (f (fst b)) (f (snd b)) = true -> Q2R r <= g y - g x \/ Q2R r <= g x - g y.
Proof.
  intros r0 fg lin hx hy h. destruct a as [p q], b as [u v]; simpl in h.
  apply on_mix in hx; destruct hx as [s [hs ex]]. apply on_mix in hy; destruct hy as [t [ht ey]]. subst. rewrite !lin, !fg.
  unfold beside in h. apply orb_true_iff in h.
  destruct h as [h|h]; apply qle_R in h; rewrite Q2R_add, Q2R_max, Q2R_min in h; [left|right];
  unfold Rmax, Rmin in h; destruct (Rle_dec (Q2R (f p)) (Q2R (f q))), (Rle_dec (Q2R (f u)) (Q2R (f v))); nra.
Qed.

Lemma leg r d e : 0 <= r -> r <= d \/ r <= - d -> r * r <= d * d + e * e.
Proof. intros r0 [h|h]; assert (0 <= e * e) by nra; nra. Qed.

Lemma boxes_apart_ok r a b x y : 0 <= Q2R r -> boxes_apart r a b = true -> on a x -> on b y -> apart (Q2R r) x y.
Proof.
  intros r0 h hx hy. unfold boxes_apart in h. apply orb_true_iff in h. destruct h as [h|h].
  - assert (k := beside_ok r fst fst a b x y r0 (fun _ => eq_refl) (fun _ _ _ => eq_refl) hx hy h).
    unfold apart, dot, sub; simpl. apply leg; [assumption|]. destruct k; [right|left]; lra.
  - assert (k := beside_ok r snd snd a b x y r0 (fun _ => eq_refl) (fun _ _ _ => eq_refl) hx hy h).
    unfold apart, dot, sub; simpl. rewrite Rplus_comm. apply leg; [assumption|]. destruct k; [right|left]; lra.
Qed.

Lemma fractions_apart_ok r a b : fractions_apart r a b = true ->
  0 <= Q2R r /\ forall x y, on a x -> on b y -> apart (Q2R r) x y.
Proof.
  unfold fractions_apart. intro h. apply andb_true_iff in h. destruct h as [r0 h]. apply qle_R in r0. rewrite Q2R_0 in r0.
  split; [assumption|]. intros x y hx hy. rewrite !orb_true_iff in h.
  destruct h as [h|[[[[[h|h]|h]|h]|h]|h]]; [now apply boxes_apart_ok with a b| | | | | |];
  eapply parted_by_ok; eauto.
Qed.

(* Whole numbers are fractions over 1, and a plane in another unit has the same segments apart. *)
Definition units (a : Q) : Q := Qmake (Qnum a) 1.
Definition seen (o p : point) : point := (Qmake (Qnum (fst p) - Qnum (fst o)) 1, Qmake (Qnum (snd p) - Qnum (snd o)) 1).

Lemma qmin_whole a b : qmin (Qmake a 1) (Qmake b 1) = Qmake (zmin a b) 1.
Proof. unfold qmin, qle, zmin; simpl. now destruct (Z.leb a b). Qed.
Lemma qmax_whole a b : qmax (Qmake a 1) (Qmake b 1) = Qmake (zmax a b) 1.
Proof. unfold qmax, qle, zmax; simpl. now destruct (Z.leb a b). Qed.
Lemma parted_by_whole rr ux uy cx cy dx dy nx ny :
  whole_parted_by rr ux uy cx cy dx dy nx ny =
  parted_by (Qmake rr 1) ((Qmake 0 1, Qmake 0 1), (Qmake ux 1, Qmake uy 1)) ((Qmake cx 1, Qmake cy 1), (Qmake dx 1, Qmake dy 1)) (Qmake nx 1, Qmake ny 1).
Proof.
  unfold parted_by, whole_parted_by, pdot, qmul, qadd; cbn [fst snd Qnum Qden Pos.eqb Pos.mul]. cbv zeta.
  rewrite !qmin_whole, !qmax_whole. unfold qsub, qopp, qadd; cbn [Qnum Qden Pos.eqb]. rewrite !qmax_whole.
  unfold qlt, qle; cbn [Qnum Qden Pos.eqb Pos.mul]. now rewrite !Z.mul_0_r.
Qed.
Lemma beside_whole r a b c : whole_beside r a b c = beside (Qmake r 1) (Qmake 0 1) (Qmake a 1) (Qmake b 1) (Qmake c 1).
Proof. unfold beside, whole_beside. rewrite !qmin_whole, !qmax_whole. reflexivity. Qed.
Lemma apart_whole r ux uy cx cy dx dy :
  whole_apart r ux uy cx cy dx dy =
  fractions_apart (Qmake r 1) ((Qmake 0 1, Qmake 0 1), (Qmake ux 1, Qmake uy 1)) ((Qmake cx 1, Qmake cy 1), (Qmake dx 1, Qmake dy 1)).
Proof.
  unfold whole_apart, fractions_apart, boxes_apart. rewrite !beside_whole, !parted_by_whole.
  unfold pturn, psub, qsub, qopp, qadd; cbn [fst snd Qnum Qden Pos.eqb Z.opp]. now rewrite !Z.add_0_r, !Z.add_0_l.
Qed.

Lemma Q2R_units a : Q2R (units a) = IZR (Zpos (Qden a)) * Q2R a.
Proof. destruct a as [n d]. unfold units, Q2R; simpl. field. apply IZR_neq. discriminate. Qed.
Lemma real_seen d o p : in_units d o = true -> in_units d p = true -> real (seen o p) = scale (IZR (Zpos d)) (sub (real p) (real o)).
Proof.
  unfold in_units. intros h k. apply andb_true_iff in h, k. destruct h as [h1 h2], k as [k1 k2]. apply Pos.eqb_eq in h1, h2, k1, k2.
  assert (e : forall a b, Qden a = d -> Qden b = d -> Q2R (Qmake (Qnum a - Qnum b) 1) = IZR (Zpos d) * (Q2R a - Q2R b)).
  { intros a b ea eb. change (Qmake (Qnum a - Qnum b) 1) with (qsub (units a) (units b)). rewrite Q2R_sub, !Q2R_units, ea, eb. ring. }
  unfold real, seen, scale, sub; simpl. now rewrite !e.
Qed.
Lemma on_seen d o a b x : in_units d o = true -> in_units d a = true -> in_units d b = true -> on (a, b) x ->
  on (seen o a, seen o b) (scale (IZR (Zpos d)) (sub x (real o))).
Proof.
  intros ho ha hb h. apply on_mix in h. destruct h as [s [hs e]]. apply on_mix. exists s. split; [assumption|]. subst.
  rewrite (real_seen d o a ho ha), (real_seen d o b ho hb). unfold mix, add, sub, scale; simpl. f_equal; ring.
Qed.

Lemma units_apart_ok r a b : units_apart r a b = true ->
  0 <= Q2R r /\ forall x y, on a x -> on b y -> apart (Q2R r) x y.
Proof.
  unfold units_apart. destruct (in_units (Qden r) (fst a) && in_units (Qden r) (snd a) && in_units (Qden r) (fst b) && in_units (Qden r) (snd b)) eqn:o;
  [|apply fractions_apart_ok].
  apply andb_true_iff in o; destruct o as [o o4]. apply andb_true_iff in o; destruct o as [o o3]. apply andb_true_iff in o; destruct o as [o1 o2].
  cbv zeta. rewrite apart_whole. intro h. rewrite <- (Z.sub_diag (Qnum (fst (fst a)))) in h at 1. rewrite <- (Z.sub_diag (Qnum (snd (fst a)))) in h at 1.
  change (fractions_apart (units r) (seen (fst a) (fst a), seen (fst a) (snd a)) (seen (fst a) (fst b), seen (fst a) (snd b)) = true) in h.
  apply fractions_apart_ok in h. destruct h as [r0 h]. rewrite Q2R_units in r0, h. set (d := IZR (Zpos (Qden r))) in *.
  assert (d0 : 0 < d) by (apply IZR_lt; reflexivity). split; [nra|]. intros x y hx hy. destruct a as [a1 a2], b as [b1 b2]; cbn [fst snd] in *.
  specialize (h _ _ (on_seen _ _ _ _ _ o1 o1 o2 hx) (on_seen _ _ _ _ _ o1 o3 o4 hy)). fold d in h.
  unfold apart, dot, sub, scale in *; simpl in *. apply Rmult_le_reg_l with (d * d); nra.
Qed.

Lemma Q2R_lift d a : Q2R (lift d a) = Q2R a.
Proof.
  unfold lift. destruct (Pos.eqb (Qden a) d); [reflexivity|]. set (k := Z.div (Zpos d) (Zpos (Qden a))).
  destruct (Z.eqb_spec (k * Zpos (Qden a)) (Zpos d)) as [h|_]; [|reflexivity]. apply Qeq_eqR. unfold Qeq; simpl. rewrite <- h. ring.
Qed.
Lemma real_lift d p : real (plift d p) = real p.
Proof. unfold real, plift; simpl. now rewrite !Q2R_lift. Qed.
Lemma on_lift d a b x : on (a, b) x -> on (plift d a, plift d b) x.
Proof. intro h. apply on_mix in h. apply on_mix. now rewrite !real_lift. Qed.

Theorem segments_apart_ok r a b : segments_apart r a b = true ->
  0 <= Q2R r /\ forall x y, on a x -> on b y -> apart (Q2R r) x y.
Proof.
  unfold segments_apart. set (d := finer (Qden r) (finer (finest a) (finest b))). intro h. apply units_apart_ok in h.
  rewrite Q2R_lift in h. destruct h as [r0 h], a as [a1 a2], b as [b1 b2]. split; [assumption|]. intros x y hx hy. apply h; now apply on_lift.
Qed.

Lemma down_ok d a : IZR (down d a) <= IZR (Zpos d) * Q2R a.
Proof.
  assert (k : (down d a * Zpos (Qden a) <= Zpos d * Qnum a)%Z).
  { unfold down. destruct (Pos.eqb_spec (Qden a) d) as [e|_]; [rewrite e; apply Z.eq_le_incl; ring|].
    rewrite Z.mul_comm, (Z.mul_comm (Zpos d)). apply Z.mul_div_le. reflexivity. }
  apply IZR_le in k. rewrite !mult_IZR in k. destruct a as [n q]; cbn [Qnum Qden] in k. unfold Q2R; cbn [Qnum Qden].
  assert (q0 : 0 < IZR (Zpos q)) by (apply IZR_lt; reflexivity). apply Rmult_le_reg_r with (IZR (Zpos q)); [assumption|].
  replace (IZR (Zpos d) * (IZR n * / IZR (Zpos q)) * IZR (Zpos q)) with (IZR (Zpos d) * IZR n) by (field; lra). assumption.
Qed.
Lemma up_ok d a : IZR (Zpos d) * Q2R a <= IZR (up d a).
Proof. unfold up. rewrite opp_IZR. pose proof (down_ok d (qopp a)) as h. rewrite Q2R_neg in h. lra. Qed.
Lemma zmin_le a b : IZR (zmin a b) <= IZR a /\ IZR (zmin a b) <= IZR b.
Proof. unfold zmin. destruct (Z.leb_spec a b); split; apply IZR_le; auto with zarith. Qed.
Lemma zmax_le a b : IZR a <= IZR (zmax a b) /\ IZR b <= IZR (zmax a b).
Proof. unfold zmax. destruct (Z.leb_spec a b); split; apply IZR_le; auto with zarith. Qed.

Definition fits (d : positive) (b : outer) (x : vec) :=
  IZR (low_x b) <= IZR (Zpos d) * fst x <= IZR (high_x b) /\ IZR (low_y b) <= IZR (Zpos d) * snd x <= IZR (high_y b).
Lemma outer_of_ok d e x : on e x -> fits d (outer_of d e) x.
Proof.
  destruct e as [a b]. intro h. apply on_mix in h. destruct h as [s [hs ex]]. subst. unfold fits, outer_of, mix, add, scale, real; simpl.
  pose proof (down_ok d (fst a)). pose proof (down_ok d (fst b)). pose proof (down_ok d (snd a)). pose proof (down_ok d (snd b)).
  pose proof (up_ok d (fst a)). pose proof (up_ok d (fst b)). pose proof (up_ok d (snd a)). pose proof (up_ok d (snd b)).
  destruct (zmin_le (down d (fst a)) (down d (fst b))), (zmin_le (down d (snd a)) (down d (snd b))),
    (zmax_le (up d (fst a)) (up d (fst b))), (zmax_le (up d (snd a)) (up d (snd b))).
  assert (k : forall l u v w, l <= u -> l <= v -> w = (1 - s) * u + s * v -> l <= w).
  { intros l u v w lu lv e. rewrite e. assert ((1 - s) * l <= (1 - s) * u) by (apply Rmult_le_compat_l; lra).
    assert (s * l <= s * v) by (apply Rmult_le_compat_l; lra). lra. }
  repeat split.
  - apply k with (IZR (Zpos d) * Q2R (fst a)) (IZR (Zpos d) * Q2R (fst b)); [lra|lra|ring].
  - apply Ropp_le_cancel. apply k with (- (IZR (Zpos d) * Q2R (fst a))) (- (IZR (Zpos d) * Q2R (fst b))); [lra|lra|ring].
  - apply k with (IZR (Zpos d) * Q2R (snd a)) (IZR (Zpos d) * Q2R (snd b)); [lra|lra|ring].
  - apply Ropp_le_cancel. apply k with (- (IZR (Zpos d) * Q2R (snd a))) (- (IZR (Zpos d) * Q2R (snd b))); [lra|lra|ring].
Qed.
Lemma outers_apart_ok r a b x y : 0 <= Q2R r -> outers_apart (Qnum r) a b = true -> fits (Qden r) a x -> fits (Qden r) b y -> apart (Q2R r) x y.
Proof.
  intros r0 h [ax ay] [bx by_]. set (d := IZR (Zpos (Qden r))) in *. assert (d0 : 0 < d) by (apply IZR_lt; reflexivity).
  assert (er : IZR (Qnum r) = d * Q2R r) by (unfold d, Q2R; field; apply IZR_neq; discriminate).
  assert (k : forall u v, IZR (Qnum r) <= d * u - d * v -> Q2R r <= u - v) by (intros u v h0; rewrite er in h0; nra).
  unfold outers_apart in h. rewrite !orb_true_iff in h. unfold apart, dot, sub; simpl.
  destruct h as [[[h|h]|h]|h]; apply Z.leb_le, IZR_le in h; rewrite plus_IZR in h;
  [| | rewrite (Rplus_comm ((fst x - fst y) * _)) | rewrite (Rplus_comm ((fst x - fst y) * _))]; (apply leg; [assumption|]).
  - right. assert (Q2R r <= fst y - fst x) by (apply k; lra). lra.
  - left. apply k. lra.
  - right. assert (Q2R r <= snd y - snd x) by (apply k; lra). lra.
  - left. apply k. lra.
Qed.
