(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Certificates that moving bodies never meet: for each piece of time and each two parts a direction that parts them. *)
Require Import Reals QArith Qreals List Bool Arith Lra Lia Psatz.
From ExactVO Require Import Theorems Plane Parity Route.
Import ListNotations.
Open Scope R_scope.

Lemma qeq_iff a b : qeq a b = true <-> Q2R a = Q2R b.
Proof.
  split; [apply qeq_R|]. intro h. unfold qeq. apply andb_true_iff. rewrite !qle_iff. lra.
Qed.

(* --- Polynomials of a share s, from their constant term on --- *)
Definition poly := list Q.
Fixpoint value (s : R) (p : poly) : R := match p with [] => 0 | c :: r => Q2R c + s * value s r end.
Definition qadd_fine (a b : Q) : Q := let d := finer (Qden a) (Qden b) in qadd (lift d a) (lift d b).
Fixpoint poly_add (a b : poly) : poly :=
  match a, b with [], _ => b | _, [] => a | x :: a, y :: b => qadd_fine x y :: poly_add a b end.
Definition poly_by (k : Q) (a : poly) : poly := map (qmul k) a.
Definition poly_sub (a b : poly) : poly := poly_add a (map qopp b).
Definition linear := (Q * Q)%type.                      (* the first, and s times the second *)
Definition linear_value (s : R) (u : linear) : R := Q2R (fst u) + s * Q2R (snd u).
Definition poly_by_linear (u : linear) (a : poly) : poly :=
  match a with [] => [] | x :: r => qmul (fst u) x :: poly_add (poly_by (fst u) r) (poly_by (snd u) a) end.

Lemma Q2R_add_fine a b : Q2R (qadd_fine a b) = Q2R a + Q2R b.
Proof. unfold qadd_fine. now rewrite Q2R_add, !Q2R_lift. Qed.
Lemma value_add s a : forall b, value s (poly_add a b) = value s a + value s b.
Proof. induction a as [|x a ih]; intros [|y b]; simpl; try lra. rewrite Q2R_add_fine, ih. ring. Qed.
Lemma value_by s k a : value s (poly_by k a) = Q2R k * value s a.
Proof. induction a as [|x a ih]; simpl; [ring|]. rewrite Q2R_mul, ih. ring. Qed.
Lemma value_opp s a : value s (map qopp a) = - value s a.
Proof. induction a as [|x a ih]; simpl; [ring|]. rewrite Q2R_neg, ih. ring. Qed.
Lemma value_sub s a b : value s (poly_sub a b) = value s a - value s b.
Proof. unfold poly_sub. rewrite value_add, value_opp. ring. Qed.
Lemma value_by_linear s u a : value s (poly_by_linear u a) = linear_value s u * value s a.
Proof.
  destruct a as [|x r]; [simpl; ring|]. unfold poly_by_linear. cbn [value]. rewrite value_add, !value_by, Q2R_mul. cbn [value]. unfold linear_value. ring.
Qed.
Lemma value_continuous p : continuity (fun s => value s p).
Proof.
  induction p as [|c r ih]; [apply continuity_const; intros x y; reflexivity|].
  apply (continuity_plus (fun _ => Q2R c) (fun s => s * value s r)); [apply continuity_const; intros x y; reflexivity|].
  apply (continuity_mult id (fun s => value s r)); [apply derivable_continuous, derivable_id|assumption].
Qed.

(* --- Ways as such polynomials, times a factor: nothing is divided --- *)
Definition poly2 := (poly * poly)%type.
Definition value2 (s : R) (p : poly2) : vec := (value s (fst p), value s (snd p)).
Definition mixed_by (w : Q) (u : linear) (a b : poly) : poly := poly_add (poly_by w a) (poly_by_linear u (poly_sub b a)).
Fixpoint qmixed_once (w : Q) (u : nat -> linear) (ps : list poly2) : list poly2 :=
  match ps with
  | a :: ((b :: _) as r) => (mixed_by w (u O) (fst a) (fst b), mixed_by w (u O) (snd a) (snd b)) :: qmixed_once w (fun i => u (S i)) r
  | _ => []
  end.
Fixpoint many (n : nat) (a : Q) : Q := match n with O => Qmake 0 (Qden a) | S n => qadd a (many n a) end.
Fixpoint qmixed (spline : bool) (w : Q) (u : linear) (n : nat) (ps : list poly2) : poly2 * Q :=
  match n with
  | O => (hd ([], []) ps, 1%Q)
  | S k =>
      let f := if spline then many n w else w in
      let (p, g) := qmixed spline w u k (qmixed_once f (fun i => if spline then (qadd (fst u) (many (n - 1 - i) w), snd u) else u) ps) in (p, qmul f g)
  end.
Definition qpowers (u : linear) (ps : list point) : poly2 :=
  fold_right (fun p more => (poly_add [fst p] (poly_by_linear u (fst more)), poly_add [snd p] (poly_by_linear u (snd more)))) ([], []) ps.
(* From one moment to another, by the share s of that time; of a trip without duration s is the share of it. *)
Definition way_of (m : trip) (from to : Q) : poly2 * Q :=
  let passed := (qsub from (leave m), qsub to from) in let w := qsub (arrive m) (leave m) in let at_once := qeq w 0 in
  let between spline := qmixed spline (if at_once then 1%Q else w) (if at_once then (0, 1)%Q else passed) (Nat.pred (length (points m)))
    (map (fun p => ([fst p], [snd p])) (points m)) in
  match meant m with
  | Powers => (qpowers passed (points m), 1%Q)
  | Bezier => between false
  | Spline => between true
  end.

Lemma Q2R_many n a : Q2R (many n a) = INR n * Q2R a.
Proof.
  induction n as [|n ih]; [simpl; unfold Q2R; simpl; lra|]. rewrite S_INR. cbn [many]. rewrite Q2R_add, ih. ring.
Qed.
Lemma mixed_by_value s w u a b share k x y : linear_value s u = share * Q2R w -> value s a = k * x -> value s b = k * y ->
  value s (mixed_by w u a b) = k * Q2R w * ((1 - share) * x + share * y).
Proof. intros hu ha hb. unfold mixed_by. rewrite value_add, value_by, value_by_linear, value_sub, hu, ha, hb. ring. Qed.
Definition times_as (s k : R) (p : poly2) (v : vec) := value2 s p = scale k v.
Lemma mixed_once_value s k w : forall ps vs u share, (forall i, linear_value s (u i) = share i * Q2R w) -> Forall2 (times_as s k) ps vs ->
  Forall2 (times_as s (k * Q2R w)) (qmixed_once w u ps) (mixed_once share vs).
Proof.
  induction ps as [|a r ih]; intros vs u share hu h; inversion h as [|? v ? vr ha hr]; subst; [constructor|].
  destruct hr as [|b c r' vr' hb hr']; [constructor|]. cbn [qmixed_once mixed_once]. constructor.
  - unfold times_as, value2, scale in ha, hb. injection ha as ha1 ha2. injection hb as hb1 hb2. unfold times_as, value2, scale, mix, add, scale; cbn [fst snd].
    f_equal; apply mixed_by_value; auto.
  - apply (ih (c :: vr') (fun i => u (S i)) (fun i => share (S i))); [intro i; apply hu|]. now constructor.
Qed.
Definition shares (spline : bool) (u : R) : nat -> nat -> R := if spline then (fun n i => (u + INR (n - 1 - i)) / INR n) else (fun _ _ => u).
Lemma mixed_value spline s u share w : linear_value s u = share * Q2R w -> forall n k ps vs, Forall2 (times_as s k) ps vs ->
  let (p, g) := qmixed spline w u n ps in times_as s (k * Q2R g) p (mixed (shares spline share) n vs).
Proof.
  intro hu. induction n as [|n ih]; intros k ps vs h.
  - cbn [qmixed mixed]. rewrite Q2R_1, Rmult_1_r. destruct h; [|assumption]. unfold times_as, value2, scale; simpl. f_equal; ring.
  - cbn [qmixed mixed]. set (f := if spline then many (S n) w else w).
    set (us := fun i => if spline return linear then (qadd (fst u) (many (S n - 1 - i) w), snd u) else u).
    assert (step : Forall2 (times_as s (k * Q2R f)) (qmixed_once f us ps) (mixed_once (shares spline share (S n)) vs)).
    { apply mixed_once_value; [|assumption]. intro i. unfold us, f, shares. destruct spline; [|assumption].
      unfold linear_value in hu |- *. cbn [fst snd]. rewrite Q2R_add, !Q2R_many. assert (INR (S n) <> 0) by (apply not_0_INR; discriminate).
      replace ((share + INR (S n - 1 - i)) / INR (S n) * (INR (S n) * Q2R w)) with (share * Q2R w + INR (S n - 1 - i) * Q2R w) by (field; assumption).
      rewrite <- hu. ring. }
    specialize (ih _ _ _ step). destruct (qmixed spline w u n (qmixed_once f us ps)) as [p g]. rewrite Q2R_mul, <- Rmult_assoc. exact ih.
Qed.
Lemma powers_value s u ps : value2 s (qpowers u ps) = fold_right (fun p more => add p (scale (linear_value s u) more)) (0, 0) (map real ps).
Proof.
  induction ps as [|p ps ih]; [reflexivity|]. cbn [qpowers fold_right map]. fold (qpowers u ps). rewrite <- ih. unfold value2, add, scale, real; cbn [fst snd].
  rewrite !value_add, !value_by_linear. simpl. f_equal; ring.
Qed.
Lemma way_ok m from to s u : (Q2R (leave m) = Q2R (arrive m) -> u = s) ->
  let (p, f) := way_of m from to in value2 s p = scale (Q2R f) (at_time m (Q2R from + s * (Q2R to - Q2R from)) u).
Proof.
  intro hu. unfold way_of, at_time. set (t := Q2R from + s * (Q2R to - Q2R from)). set (l := Q2R (leave m)) in *. set (a := Q2R (arrive m)) in *.
  set (passed := (qsub from (leave m), qsub to from)). set (at_once := qeq (qsub (arrive m) (leave m)) 0).
  assert (hp : linear_value s passed = t - l) by (unfold linear_value, passed, t; cbn [fst snd]; rewrite !Q2R_sub; unfold l; ring).
  assert (hw : linear_value s (if at_once then (0, 1)%Q else passed) = (if Req_EM_T l a then u else (t - l) / (a - l)) * Q2R (if at_once then 1%Q else qsub (arrive m) (leave m))).
  { destruct at_once eqn:e; unfold at_once in e.
    - apply qeq_R in e. rewrite Q2R_sub, Q2R_0 in e. fold l a in e. destruct (Req_EM_T l a) as [k|k]; [|exfalso; apply k; lra].
      rewrite hu by assumption. unfold linear_value; cbn [fst snd]. rewrite Q2R_0, Q2R_1. ring.
    - destruct (Req_EM_T l a) as [k|k].
      + exfalso. assert (q : qeq (qsub (arrive m) (leave m)) 0 = true); [|congruence].
        unfold qeq. apply andb_true_iff. rewrite !qle_iff, Q2R_sub, Q2R_0. fold l a. lra.
      + rewrite hp, Q2R_sub. fold l a. field. lra. }
  set (u' := if Req_EM_T l a then u else (t - l) / (a - l)) in *. unfold on_way. rewrite map_length.
  assert (start : Forall2 (times_as s 1) (map (fun p => ([fst p], [snd p])) (points m)) (map real (points m))).
  { induction (points m) as [|p r ih]; [constructor|]. constructor; [|assumption]. unfold times_as, value2, scale, real; simpl. f_equal; ring. }
  destruct (meant m).
  - rewrite powers_value, hp, Q2R_1. unfold scale; cbn [fst snd]. rewrite !Rmult_1_l. now rewrite <- surjective_pairing.
  - pose proof (mixed_value false s _ _ _ hw (Nat.pred (length (points m))) 1 _ _ start) as k. destruct (qmixed _ _ _ _ _) as [p g].
    rewrite Rmult_1_l in k. exact k.
  - pose proof (mixed_value true s _ _ _ hw (Nat.pred (length (points m))) 1 _ _ start) as k. destruct (qmixed _ _ _ _ _) as [p g].
    rewrite Rmult_1_l in k. exact k.
Qed.

(* The share of the time between two moments. *)
Definition share (from to : Q) (t s : R) : R := if Req_EM_T (Q2R from) (Q2R to) then s else (t - Q2R from) / (Q2R to - Q2R from).
Lemma share_ok from to t s : 0 <= s <= 1 -> Q2R from <= t <= Q2R to ->
  0 <= share from to t s <= 1 /\ Q2R from + share from to t s * (Q2R to - Q2R from) = t /\ (Q2R from = Q2R to -> share from to t s = s).
Proof.
  intros hs ht. unfold share. destruct (Req_EM_T (Q2R from) (Q2R to)) as [e|n].
  - split; [assumption|]. split; [rewrite e; lra|reflexivity].
  - split; [apply share_bounds; lra|]. split; [field; lra|contradiction].
Qed.

(* --- Coefficients of Bernstein, times binomials: those of s^i (1 - s)^(d - i) --- *)
Definition nought (d : positive) : Q := Qmake 0 d.
Fixpoint pascal (d : nat) : poly := match d with O => [1%Q] | S d => let r := pascal d in poly_add (r ++ [0%Q]) (0%Q :: r) end.
Fixpoint bernstein (d : nat) (f : poly) : poly :=
  match f with
  | [] => map (fun _ => 0%Q) (pascal d)
  | c :: r => match d with O => [c] | S k => poly_add (poly_by c (pascal d)) (nought (Qden c) :: bernstein k r) end
  end.
Fixpoint spread (s : R) (l : poly) : R := match l with [] => 0 | c :: r => Q2R c * (1 - s) ^ length r + s * spread s r end.

Lemma length_add a : forall b, length a = length b -> length (poly_add a b) = length a.
Proof. induction a as [|x a ih]; intros [|y b] h; try discriminate; [reflexivity|]. simpl. f_equal. apply ih. now injection h. Qed.
Lemma spread_add s a : forall b, length a = length b -> spread s (poly_add a b) = spread s a + spread s b.
Proof.
  induction a as [|x a ih]; intros [|y b] h; try discriminate; [simpl; ring|]. injection h as h. simpl. rewrite length_add, <- h, ih, Q2R_add_fine by assumption. ring.
Qed.
Lemma spread_by s k a : spread s (poly_by k a) = Q2R k * spread s a.
Proof. induction a as [|x a ih]; simpl; [ring|]. unfold poly_by in *. rewrite map_length, Q2R_mul, ih. ring. Qed.
Lemma spread_snoc s a : spread s (a ++ [0%Q]) = (1 - s) * spread s a.
Proof. induction a as [|x a ih]; simpl; [rewrite Q2R_0; ring|]. rewrite ih, app_length, Nat.add_1_r. simpl. ring. Qed.
Lemma spread_noughts s a : spread s (map (fun _ : Q => 0%Q) a) = 0.
Proof. induction a as [|x a ih]; simpl; [reflexivity|]. rewrite ih, Q2R_0. ring. Qed.
Lemma pascal_ok s d : length (pascal d) = S d /\ spread s (pascal d) = 1.
Proof.
  induction d as [|d [l h]]; [split; [reflexivity|simpl; rewrite Q2R_1; ring]|]. cbn [pascal].
  assert (e : length (pascal d ++ [0%Q]) = length (0%Q :: pascal d)) by (rewrite app_length, Nat.add_1_r; reflexivity).
  rewrite length_add, spread_add, spread_snoc by assumption. split; [now rewrite e; simpl; rewrite l|]. cbn [spread]. rewrite h, Q2R_0. ring.
Qed.
Lemma bernstein_ok s d : forall f, (length f <= S d)%nat -> length (bernstein d f) = S d /\ spread s (bernstein d f) = value s f.
Proof.
  induction d as [|d ih]; intros [|c r] h.
  - split; [reflexivity|]. simpl. rewrite Q2R_0. ring.
  - destruct r; [|simpl in h; lia]. split; [reflexivity|]. simpl. ring.
  - cbn [bernstein]. destruct (pascal_ok s (S d)) as [l _]. rewrite map_length, spread_noughts. now split.
  - cbn [bernstein]. destruct (pascal_ok s (S d)) as [l p]. destruct (ih r) as [lr hr]; [simpl in h; lia|].
    assert (e : length (poly_by c (pascal (S d))) = length (nought (Qden c) :: bernstein d r)) by (unfold poly_by; rewrite map_length, l; simpl; now rewrite lr).
    rewrite length_add, spread_add by assumption. split; [rewrite e; simpl; now rewrite lr|]. rewrite spread_by, p. cbn [spread]. rewrite hr.
    replace (Q2R (nought (Qden c))) with 0 by (unfold nought, Q2R; simpl; ring). cbn [value]. ring.
Qed.
(* What all coefficients exceed the polynomial exceeds. *)
Lemma spread_above s low bs : 0 <= s <= 1 -> forall cs, length cs = length bs -> cs <> [] -> (forall c b, In (c, b) (combine cs bs) -> low * Q2R b < Q2R c) ->
  low * spread s bs < spread s cs.
Proof.
  intro hs. induction bs as [|b bs ih]; intros [|c cs] l n h; try discriminate; [congruence|]. injection l as l. cbn [spread].
  assert (first := h c b (or_introl eq_refl)). rewrite <- l. assert (p : 0 <= (1 - s) ^ length cs) by (apply pow_le; lra).
  destruct cs as [|c' cs'].
  - destruct bs; [|discriminate]. simpl. lra.
  - specialize (ih (c' :: cs') l ltac:(discriminate) (fun x y k => h x y (or_intror k))).
    set (X := spread s bs) in *. set (Y := spread s (c' :: cs')) in *. destruct (Req_dec s 0) as [z|z].
    + subst s. rewrite Rminus_0_r, pow1. lra.
    + assert (0 < s) by lra. set (P := (1 - s) ^ length (c' :: cs')) in *. assert (low * Q2R b * P <= Q2R c * P) by (apply Rmult_le_compat_r; lra).
      assert (s * (low * X) < s * Y) by (apply Rmult_lt_compat_l; lra). lra.
Qed.

(* --- One separation --- *)
Definition wide (n : point) (reaches width : Q) (gap : option Q) : bool :=
  match gap with
  | None => false
  | Some g => qlt 0 g && (let m := qadd reaches width in let left := qmul g g in let right := qmul (qmul m m) (pdot n n) in
      if qlt 0 width then qle right left else qlt right left)
  end.
Definition separates (a b : trip) (p q : part) (s : separation) : bool :=
  match corners p, corners q with
  | v :: vs, w :: ws =>
      let n := direction s in let r := qadd (reach p) (reach q) in let most := qsub (highest n w ws) (lowest n v vs) in
      let (pa, fa) := way_of a (since s) (until s) in let (pb, fb) := way_of b (since s) (until s) in let k := qmul fa fb in
      let away x y := poly_sub (poly_by fb x) (poly_by fa y) in
      let f := poly_add (poly_by (fst n) (away (fst pa) (fst pb))) (poly_by (snd n) (away (snd pa) (snd pb))) in
      let d := Nat.max 1 (Nat.max (Nat.pred (length (points a))) (Nat.pred (length (points b)))) in
      qle 0 (reach p) && qle 0 (reach q) && qle 0 (width s) && qlt 0 fa && qlt 0 fb && Nat.leb (length f) (S d)
      && forallb (fun x => let (c, binomial) := (x : Q * Q) in let m := qmul k binomial in
           qle 0 m && wide n (qmul m r) (qmul m (width s)) (Some (qadd_fine c (qopp (qmul m most))))) (combine (bernstein d f) (pascal d))
  | _, _ => false
  end.

Lemma wide_ok n r width gap : 0 <= Q2R r -> 0 <= Q2R width -> wide n r width gap = true ->
  exists g, gap = Some g /\ 0 < Q2R g /\ Q2R r * Q2R r * dot (real n) (real n) < Q2R g * Q2R g.
Proof.
  intros r0 w0 h. unfold wide in h. destruct gap as [g|]; [|discriminate]. exists g. split; [reflexivity|].
  apply andb_true_iff in h. destruct h as [g0 h]. apply qlt_R in g0. rewrite Q2R_0 in g0. split; [assumption|].
  pose proof (dot_self (real n)) as nn. destruct (qlt 0 width) eqn:e.
  - apply qlt_R in e. apply qle_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. rewrite Q2R_0 in e.
    destruct (Rle_lt_or_eq_dec _ _ nn) as [n0|n0]; [|rewrite <- n0, Rmult_0_r; now apply Rmult_lt_0_compat].
    apply Rlt_le_trans with (2 := h). apply Rmult_lt_compat_r; [assumption|]. nra.
  - apply qlt_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. apply Rle_lt_trans with (2 := h). apply Rmult_le_compat_r; [assumption|]. nra.
Qed.

Definition strictly_apart (r : R) (x y : vec) := r * r < dot (sub x y) (sub x y).
Lemma far_strict n z r g : 0 < g -> r * r * dot n n < g * g -> g <= dot n z -> r * r < dot z z.
Proof.
  intros g0 h k. assert (k2 : g * g <= dot n z * dot n z) by nra. pose proof (cauchy_schwarz n z). pose proof (dot_self n). pose proof (dot_self z).
  destruct (Rlt_or_le (r * r) (dot z z)); [assumption|]. exfalso. nra.
Qed.

Lemma root_times g r n : 0 <= r -> 0 < g -> r * r * dot n n < g * g -> r * sqrt (dot n n) < g.
Proof.
  intros r0 g0 h. pose proof (dot_self n) as nn. pose proof (sqrt_sqrt (dot n n) nn). pose proof (sqrt_pos (dot n n)).
  destruct (Rlt_or_le (r * sqrt (dot n n)) g); [assumption|]. exfalso. set (k := sqrt (dot n n)) in *.
  assert (g * g <= (r * k) * (r * k)) by (apply Rmult_le_compat; lra). nra.
Qed.

Definition parted_between (a b : trip) (p q : part) (t s : R) := forall x y, hull (corners p) x -> hull (corners q) y ->
  strictly_apart (Q2R (reach p) + Q2R (reach q)) (add (at_time a t s) x) (add (at_time b t s) y).
Lemma separates_ok a b p q s : separates a b p q s = true ->
  Q2R (leave a) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive a) -> Q2R (leave b) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ forall t u, Q2R (since s) <= t <= Q2R (until s) -> 0 <= u <= 1 -> parted_between a b p q t u.
Proof.
  unfold separates. destruct (corners p) as [|v vs] eqn:ep; [discriminate|]. destruct (corners q) as [|w ws] eqn:eq; [discriminate|].
  set (n := direction s). set (r := qadd (reach p) (reach q)). set (most := qsub (highest n w ws) (lowest n v vs)).
  destruct (way_of a (since s) (until s)) as [pa fa] eqn:ea. destruct (way_of b (since s) (until s)) as [pb fb] eqn:eb.
  set (k := qmul fa fb). set (f := poly_add _ _). set (d := Nat.max _ _). intros h la aa lb ab.
  apply andb_true_iff in h; destruct h as [h all]. apply andb_true_iff in h; destruct h as [h len]. apply Nat.leb_le in len.
  apply andb_true_iff in h; destruct h as [h fb0]. apply andb_true_iff in h; destruct h as [h fa0]. apply andb_true_iff in h; destruct h as [h w0].
  apply andb_true_iff in h; destruct h as [p0 q0]. apply qlt_R in fa0, fb0. apply qle_R in p0, q0, w0. rewrite Q2R_0 in *.
  split; [assumption|]. split; [assumption|]. intros t u ht hu x y hx hy. rewrite ep in hx. rewrite eq in hy.
  destruct (share_ok (since s) (until s) t u hu ht) as [s01 [st su]]. set (z := share (since s) (until s) t u) in *.
  pose proof (way_ok a (since s) (until s) z u ltac:(intro e; symmetry; apply su; lra)) as wa. rewrite ea, st in wa.
  pose proof (way_ok b (since s) (until s) z u ltac:(intro e; symmetry; apply su; lra)) as wb. rewrite eb, st in wb.
  set (A := at_time a t u) in *. set (B := at_time b t u) in *. unfold value2, scale in wa, wb. injection wa as wa1 wa2. injection wb as wb1 wb2.
  assert (k0 : 0 < Q2R k) by (unfold k; rewrite Q2R_mul; now apply Rmult_lt_0_compat).
  assert (hf : value z f = Q2R k * dot (real n) (sub A B)).
  { unfold f. rewrite value_add, !value_by, !value_sub, !value_by, wa1, wa2, wb1, wb2. unfold k, dot, sub, real; cbn [fst snd]. rewrite Q2R_mul. ring. }
  destruct (bernstein_ok z d f len) as [bl bv]. destruct (pascal_ok z d) as [pl pv].
  set (N := sqrt (dot (real n) (real n))) in *. assert (N0 : 0 <= N) by apply sqrt_pos. assert (NN : N * N = dot (real n) (real n)) by (apply sqrt_sqrt, dot_self).
  assert (r0 : 0 <= Q2R r) by (unfold r; rewrite Q2R_add; lra).
  assert (low : Q2R k * (Q2R most + Q2R r * N) * spread z (pascal d) < spread z (bernstein d f)).
  { apply spread_above; [assumption|congruence|intro e; rewrite e in bl; discriminate|]. intros c m hin. rewrite forallb_forall in all. specialize (all _ hin).
    cbv beta iota in all. apply andb_true_iff in all. destruct all as [m0 wd]. apply qle_R in m0. rewrite Q2R_0 in m0.
    assert (r1 : 0 <= Q2R (qmul (qmul k m) r)) by (rewrite Q2R_mul; now apply Rmult_le_pos).
    assert (w1 : 0 <= Q2R (qmul (qmul k m) (width s))) by (rewrite Q2R_mul; now apply Rmult_le_pos).
    destruct (wide_ok _ _ _ _ r1 w1 wd) as [g [eg [g0 gg]]]. injection eg as eg. apply root_times in gg; [|assumption|assumption].
    fold N in gg. rewrite <- eg, Q2R_add_fine, Q2R_neg, !Q2R_mul in gg. lra. }
  rewrite pv, bv, hf, Rmult_1_r in low. apply Rmult_lt_reg_l in low; [|assumption].
  assert (hm : dot (real n) y - dot (real n) x <= Q2R most).
  { unfold most. rewrite Q2R_sub. pose proof (hull_above (real n) _ _ (lowest_ok n vs v) x hx). pose proof (hull_below (real n) _ _ (highest_ok n ws w) y hy). lra. }
  assert (e : dot (real n) (sub (add A x) (add B y)) = dot (real n) (sub A B) + dot (real n) x - dot (real n) y) by (unfold dot, sub, add; simpl; ring).
  unfold r in low, r0. rewrite Q2R_add in low, r0. unfold strictly_apart. apply (far_strict (real n) _ _ (dot (real n) (sub (add A x) (add B y)))); rewrite ?e.
  - assert (0 <= (Q2R (reach p) + Q2R (reach q)) * N) by (apply Rmult_le_pos; lra). lra.
  - rewrite <- NN. set (R0 := Q2R (reach p) + Q2R (reach q)) in *. replace (R0 * R0 * (N * N)) with ((R0 * N) * (R0 * N)) by ring.
    assert (0 <= R0 * N) by (apply Rmult_le_pos; lra). apply Rmult_le_0_lt_compat; lra.
  - lra.
Qed.

(* --- A list of them, maybe with more than that (`of` leaves it away): of each two parts in turn, without a gap --- *)
Fixpoint taken {S} (of : S -> separation) (fits : S -> bool) (from to : Q) (l : list S) : option (list S) :=
  match l with
  | [] => None
  | x :: r => let s := of x in
      if qeq (since s) from && qle (since s) (until s) && qle (until s) to && fits x
      then if qeq (until s) to then Some r else taken of fits (until s) to r else None
  end.
Lemma taken_ok {S} (of : S -> separation) fits to l : forall from rest, taken of fits from to l = Some rest -> incl rest l /\ forall t, Q2R from <= t <= Q2R to ->
  exists x, In x l /\ fits x = true /\ Q2R from <= Q2R (since (of x)) /\ Q2R (until (of x)) <= Q2R to /\ Q2R (since (of x)) <= t <= Q2R (until (of x)).
Proof.
  induction l as [|x r ih]; intros from rest h; [discriminate|]. simpl in h.
  destruct (qeq (since (of x)) from) eqn:e; [|discriminate]. destruct (qle (since (of x)) (until (of x))) eqn:o; [|discriminate].
  destruct (qle (until (of x)) to) eqn:u; [|discriminate]. destruct (fits x) eqn:fs; [|discriminate]. simpl in h.
  apply qeq_R in e. apply qle_R in o, u. destruct (qeq (until (of x)) to) eqn:d.
  - injection h as h. subst. apply qeq_R in d. split; [apply incl_tl, incl_refl|]. intros t ht. exists x. split; [now left|]. split; [assumption|]. repeat split; lra.
  - destruct (ih _ _ h) as [i k]. split; [now apply incl_tl|]. intros t ht.
    destruct (Rle_or_lt t (Q2R (until (of x)))) as [l|l]; [exists x; split; [now left|]; split; [assumption|]; repeat split; lra|].
    destruct (k t) as [y [h0 [h1 [h2 [h3 h4]]]]]; [lra|]. exists y. split; [now right|]. split; [assumption|]. repeat split; lra.
Qed.

Definition numbered {A} (l : list A) : list (nat * A) := combine (seq 0 (length l)) l.
Definition pairs {A B} (l : list A) (m : list B) : list ((nat * A) * (nat * B)) := list_prod (numbered l) (numbered m).
Definition of_pair {S} (of : S -> separation) (i j : nat) (fits : S -> bool) (x : S) : bool := Nat.eqb (part_no (of x)) i && Nat.eqb (other_no (of x)) j && fits x.
Fixpoint all_taken {A B S} (of : S -> separation) (fits : A -> B -> S -> bool) (from to : Q) (ps : list ((nat * A) * (nat * B))) (l : list S) : bool :=
  match ps with
  | [] => match l with [] => true | _ => false end
  | ((i, p), (j, q)) :: ps =>
      match taken of (of_pair of i j (fits p q)) from to l with
      | Some rest => all_taken of fits from to ps rest
      | None => false
      end
  end.
Definition sweep (a b : trip) (l : list separation) : bool :=
  let from := qmax (leave a) (leave b) in let to := qmin (arrive a) (arrive b) in
  if qlt to from then match l with [] => true | _ => false end else all_taken (fun s => s) (separates a b) from to (pairs (parts a) (parts b)) l.

Lemma in_numbered {A} (l : list A) x : In x l -> exists i, In (i, x) (numbered l).
Proof.
  unfold numbered. generalize 0%nat. induction l as [|y l ih]; intros k h; [destruct h|]. simpl.
  destruct h as [e|h]; [subst; exists k; now left|]. destruct (ih (S k) h) as [i hi]. exists i. now right.
Qed.
Lemma all_taken_ok {A B S} of (fits : A -> B -> S -> bool) from to ps : forall l, all_taken of fits from to ps l = true ->
  forall i p j q, In ((i, p), (j, q)) ps -> exists m rest, incl m l /\ taken of (of_pair of i j (fits p q)) from to m = Some rest.
Proof.
  induction ps as [|[[i0 p0] [j0 q0]] ps ih]; intros l h i p j q hin; [destruct hin|]. simpl in h.
  destruct (taken _ _ from to l) as [rest|] eqn:e; [|discriminate]. destruct hin as [eq|hin]; [injection eq as; subst; exists l, rest; split; [apply incl_refl|assumption]|].
  destruct (ih rest h i p j q hin) as [m [r [hm hr]]]. exists m, r. split; [|assumption]. apply incl_tran with (1 := hm). now apply (taken_ok _ _ _ _ _ _ e).
Qed.
(* Of each two parts one fits at each moment. *)
Lemma all_taken_fits {A B S} of (fits : A -> B -> S -> bool) from to (ps : list A) (qs : list B) l : all_taken of fits from to (pairs ps qs) l = true ->
  forall p q t, In p ps -> In q qs -> Q2R from <= t <= Q2R to ->
  exists x, In x l /\ fits p q x = true /\ Q2R from <= Q2R (since (of x)) /\ Q2R (until (of x)) <= Q2R to /\ Q2R (since (of x)) <= t <= Q2R (until (of x)).
Proof.
  intros h p q t hp hq ht. destruct (in_numbered _ _ hp) as [i hi]. destruct (in_numbered _ _ hq) as [j hj].
  destruct (all_taken_ok _ _ _ _ _ _ h i p j q) as [l' [rest [hl k]]]; [now apply in_prod|].
  destruct (taken_ok _ _ _ _ _ _ k) as [_ some]. destruct (some t ht) as [x [hx [hs more]]]. apply andb_true_iff in hs. exists x. split; [now apply hl|]. now split.
Qed.

Lemma sweep_parts a b l : sweep a b l = true -> forall t s p q, under_way a t -> under_way b t -> 0 <= s <= 1 -> In p (parts a) -> In q (parts b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ parted_between a b p q t s.
Proof.
  unfold sweep. intros h t u p q ua ub hu hp hq. unfold under_way in ua, ub.
  set (from := qmax (leave a) (leave b)) in *. set (to := qmin (arrive a) (arrive b)) in *.
  assert (ef : Q2R (leave a) <= Q2R from /\ Q2R (leave b) <= Q2R from /\ (Q2R from <= t)).
  { unfold from. rewrite Q2R_max. repeat split; [apply Rmax_l|apply Rmax_r|]. apply Rmax_lub; lra. }
  assert (et : Q2R to <= Q2R (arrive a) /\ Q2R to <= Q2R (arrive b) /\ (t <= Q2R to)).
  { unfold to. rewrite Q2R_min. repeat split; [apply Rmin_l|apply Rmin_r|]. apply Rmin_glb; lra. }
  destruct (qlt to from) eqn:e; [apply qlt_R in e; exfalso; lra|].
  destruct (all_taken_fits _ _ _ _ _ _ _ h p q t hp hq) as [s [_ [hs [s1 [s2 s3]]]]]; [lra|].
  apply separates_ok in hs; [|lra|lra|lra|lra].
  destruct hs as [p0 [q0 hs]]. split; [assumption|]. split; [assumption|]. now apply hs.
Qed.

Lemma no_common (r q : R) u v z : 0 <= r -> 0 <= q -> strictly_apart (r + q) u v ->
  dot (sub z u) (sub z u) <= r * r -> dot (sub z v) (sub z v) <= q * q -> False.
Proof.
  unfold strictly_apart. intros r0 q0 h hu hv. assert (k := bounded_dot (sub u z) (sub z v) r q r0 q0).
  assert (e : dot (sub u z) (sub u z) = dot (sub z u) (sub z u)) by (unfold dot, sub; simpl; ring). rewrite e in k. specialize (k hu hv).
  assert (f : dot (sub u v) (sub u v) = dot (sub z u) (sub z u) + 2 * dot (sub u z) (sub z v) + dot (sub z v) (sub z v)) by (unfold dot, sub; simpl; ring).
  rewrite f in h. nra.
Qed.

Theorem sweep_sound a b l : sweep a b l = true -> never_meet a b.
Proof.
  intros h t s x ua ub hs [p [y [hp [hy dy]]]] [q [z [hq [hz dz]]]].
  destruct (sweep_parts _ _ _ h t s p q ua ub hs hp hq) as [p0 [q0 k]]. apply (no_common _ _ _ _ x p0 q0 (k y z hy hz) dy dz).
Qed.

(* --- Past an obstacle: its edges are bodies at rest, and no part begins inside --- *)
Definition at_rest (m : trip) (es : list edge) : trip :=
  {| leave := leave m; arrive := arrive m; meant := Bezier; points := [(0, 0)%Q]; parts := map (fun e => {| corners := [fst e; snd e]; reach := 0%Q |}) es |}.
Definition padd (a b : point) : point := (qadd (fst a) (fst b), qadd (snd a) (snd b)).
Definition begins_outside (place : point) (ps : list part) (o : obstacle) (es : list edge) : bool :=
  match o with
  | Wall _ => true
  | Solid _ => forallb (fun p => match corners p with [] => false | v :: _ => negb (qodd es (padd place v)) end) ps
  end.
(* Its place at the start, and whether the factors of its ways are above 0. *)
Definition begins (m : trip) : option point :=
  let (p, f) := way_of m (leave m) (leave m) in
  if qlt 0 f && qlt 0 (snd (way_of m (leave m) (arrive m))) then Some (qmul (Qinv f) (hd 0%Q (fst p)), qmul (Qinv f) (hd 0%Q (snd p))) else None.
Definition sweep_past (m : trip) (o : obstacle) (l : list separation) : bool :=
  let es := edges_of o in sweep m (at_rest m es) l && match begins m with Some x => begins_outside x (parts m) o es | None => false end.

Lemma rest_place m es t s : at_time (at_rest m es) t s = (0, 0).
Proof. unfold at_time, on_way, at_rest, real; simpl. now rewrite Q2R_0. Qed.
Lemma value_0 p : value 0 p = Q2R (hd 0%Q p).
Proof. destruct p as [|c r]; simpl; [now rewrite Q2R_0|ring]. Qed.
Lemma begins_ok m x : begins m = Some x -> real x = at_time m (Q2R (leave m)) 0 /\ 0 < Q2R (snd (way_of m (leave m) (arrive m))).
Proof.
  unfold begins. pose proof (way_ok m (leave m) (leave m) 0 0 (fun _ => eq_refl)) as k. destruct (way_of m (leave m) (leave m)) as [p f].
  destruct (qlt 0 f && qlt 0 (snd (way_of m (leave m) (arrive m)))) eqn:e; [|discriminate]. intro h. injection h as h. subst x. apply andb_true_iff in e. destruct e as [f0 g0].
  apply qlt_R in f0, g0. rewrite Q2R_0 in f0, g0. split; [|assumption]. replace (Q2R (leave m) + 0 * (Q2R (leave m) - Q2R (leave m))) with (Q2R (leave m)) in k by ring.
  set (A := at_time m (Q2R (leave m)) 0) in *. unfold value2, scale in k. injection k as k1 k2. rewrite value_0 in k1, k2. unfold real; cbn [fst snd].
  rewrite !Q2R_mul, k1, k2, Q2R_inv by (intro z; apply Qeq_eqR in z; rewrite Q2R_0 in z; lra). rewrite (surjective_pairing A). cbn [fst snd]. f_equal; field; lra.
Qed.
(* Up to a moment the way is a continuous path. *)
Lemma value_near p t e : 0 < e -> exists d, 0 < d /\ forall s, Rabs (s - t) < d -> Rabs (value s p - value t p) < e.
Proof.
  intro e0. destruct (value_continuous p t e e0) as [d [d0 hd]]. exists d. split; [assumption|]. intros s hs. destruct (Req_dec s t) as [q|n].
  - subst. now rewrite Rminus_diag_eq, Rabs_R0.
  - apply (hd s). split; [|assumption]. split; [exact I|]. now apply not_eq_sym.
Qed.
Lemma way_continuous p f l v : 0 <= l <= 1 -> 0 < f -> continuous (fun u => add (scale (/ f) (value2 (u * l) p)) v).
Proof.
  intros hl f0 t _ e e0. assert (ef : 0 < e * f) by now apply Rmult_lt_0_compat.
  destruct (value_near (fst p) (t * l) _ ef) as [d [d0 hd]]. destruct (value_near (snd p) (t * l) _ ef) as [c [c0 hc]].
  exists (Rmin d c). split; [now apply Rmin_glb_lt|]. intros s _ hs. pose proof (Rmin_l d c). pose proof (Rmin_r d c).
  assert (hsl : Rabs (s * l - t * l) <= Rabs (s - t)).
  { replace (s * l - t * l) with ((s - t) * l) by ring. rewrite Rabs_mult, (Rabs_right l) by lra. pose proof (Rabs_pos (s - t)). nra. }
  specialize (hd (s * l) ltac:(lra)). specialize (hc (s * l) ltac:(lra)).
  assert (small : forall x y, Rabs (x - y) < e * f -> Rabs (/ f * x - / f * y) < e).
  { intros x y h. replace (/ f * x - / f * y) with ((x - y) * / f) by ring. rewrite Rabs_mult, (Rabs_right (/ f)) by (left; now apply Rinv_0_lt_compat).
    apply Rmult_lt_reg_r with f; [assumption|]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. assumption. }
  unfold near, add, scale, value2; cbn [fst snd]. split.
  - replace (/ f * value (s * l) (fst p) + fst v - (/ f * value (t * l) (fst p) + fst v)) with (/ f * value (s * l) (fst p) - / f * value (t * l) (fst p)) by ring. now apply small.
  - replace (/ f * value (s * l) (snd p) + snd v - (/ f * value (t * l) (snd p) + snd v)) with (/ f * value (s * l) (snd p) - / f * value (t * l) (snd p)) by ring. now apply small.
Qed.

Lemma past_edges m o l : sweep m (at_rest m (edges_of o)) l = true -> forall t s x e, under_way m t -> 0 <= s <= 1 -> covers m t s x -> In e (edges_of o) -> ~ on e x.
Proof.
  intros h t s x e ut hs c he ox. apply (sweep_sound _ _ _ h t s x ut ut hs c).
  exists {| corners := [fst e; snd e]; reach := 0%Q |}, x. split; [simpl; apply in_map_iff; now exists e|]. split; [exact ox|].
  rewrite rest_place. simpl. rewrite Q2R_0. unfold dot, sub, add; simpl. nra.
Qed.

Lemma straight_even es x y : closed es -> (forall u, 0 <= u <= 1 -> off es (mix u x y)) -> odd es x = false -> odd es y = false.
Proof.
  intros c h k. rewrite <- (mix_0 x y) in k. rewrite <- (mix_1 x y). rewrite <- k. symmetry.
  apply (odd_path es (fun t => mix t x y) c (mix_continuous _ _) h).
Qed.

Lemma begins_outside_ok place ps rs : begins_outside place ps (Solid rs) (edges_of (Solid rs)) = true -> forall p, In p ps ->
  exists v, hull (corners p) v /\ odd (edges_of (Solid rs)) (add (real place) v) = false.
Proof.
  unfold begins_outside. intros h p hp. rewrite forallb_forall in h. specialize (h p hp). destruct (corners p) as [|v vs]; [discriminate|].
  apply negb_true_iff in h. rewrite qodd_ok in h. exists (real v). split; [apply corner; now left|]. rewrite <- h. f_equal.
  unfold padd, add, real; simpl. now rewrite !Q2R_add.
Qed.

(* What holds of one point of a part holds of the whole part, out to its reach, if no edge comes near. *)
Lemma whole_part_even es (place : vec -> vec) cs r v y x : closed es -> 0 <= r -> (forall u a b, place (mix u a b) = mix u (place a) (place b)) ->
  (forall z q, hull cs z -> dot (sub q (place z)) (sub q (place z)) <= r -> off es q) -> hull cs v -> hull cs y ->
  dot (sub x (place y)) (sub x (place y)) <= r -> odd es (place v) = false -> odd es x = false.
Proof.
  intros cl r0 affine far hv hy hx h.
  assert (at_part : forall z, hull cs z -> off es (place z)).
  { intros z hz. apply (far z _ hz). replace (dot (sub (place z) (place z)) (sub (place z) (place z))) with 0 by (unfold dot, sub; simpl; ring). assumption. }
  assert (b : odd es (place y) = false).
  { apply (straight_even es (place v)); [assumption| |assumption]. intros u hu. rewrite <- affine. apply at_part. now apply chord. }
  apply (straight_even es (place y)); [assumption| |exact b]. intros u hu. apply (far y _ hy). set (c := place y) in *.
  replace (dot (sub (mix u c x) c) (sub (mix u c x) c)) with (u * u * dot (sub x c) (sub x c)) by (unfold dot, sub, mix, add, scale; simpl; ring).
  pose proof (dot_self (sub x c)). assert (u * u <= 1) by nra. nra.
Qed.

Theorem sweep_past_sound m o l : sweep_past m o l = true -> stays_out m o.
Proof.
  unfold sweep_past. intro h. apply andb_true_iff in h. destruct h as [h b]. destruct (begins m) as [x0|] eqn:bm; [|discriminate].
  destruct (begins_ok m x0 bm) as [ex f0]. assert (k := past_edges m o l h).
  intros t s x ut hs c. split; [|intros e he; now apply (k t s x e)].
  intros o' [eo|[]]. subst o'. destruct o as [w|rs]; [exact I|]. set (es := edges_of (Solid rs)) in *.
  assert (cl : closed es) by apply rings_closed. destruct c as [p [y [hp [hy dy]]]].
  destruct (begins_outside_ok _ _ _ b p hp) as [v [hv bv]]. fold es in bv.
  assert (r0 : 0 <= Q2R (reach p) * Q2R (reach p)) by nra.
  assert (far : forall t s z q, under_way m t -> 0 <= s <= 1 -> hull (corners p) z ->
    dot (sub q (add (at_time m t s) z)) (sub q (add (at_time m t s) z)) <= Q2R (reach p) * Q2R (reach p) -> off es q).
  { intros t' s' z q ut' hs' hz hq e he. apply (k t' s' _ e ut' hs'); [|exact he]. now exists p, z. }
  apply (whole_part_even es (add (at_time m t s)) (corners p) (Q2R (reach p) * Q2R (reach p)) v y); try assumption.
  { intros u a c. unfold mix, add, scale; simpl. f_equal; ring. }
  { intros z q. now apply far. }
  (* Along the trip. *)
  assert (here : forall t s, under_way m t -> 0 <= s <= 1 -> off es (add (at_time m t s) v)).
  { intros t' s' ut' hs'. apply (far t' s' v); [assumption|assumption|assumption|].
    replace (dot (sub (add (at_time m t' s') v) (add (at_time m t' s') v)) (sub (add (at_time m t' s') v) (add (at_time m t' s') v))) with 0
      by (unfold dot, sub; simpl; ring). assumption. }
  destruct (share_ok (leave m) (arrive m) t s hs ut) as [l01 [lt le_]]. set (y0 := share (leave m) (arrive m) t s) in *.
  destruct (way_of m (leave m) (arrive m)) as [w f] eqn:ew. cbn [snd] in f0.
  assert (on : forall u z, (Q2R (leave m) = Q2R (arrive m) -> z = u) -> scale (/ Q2R f) (value2 u w) = at_time m (Q2R (leave m) + u * (Q2R (arrive m) - Q2R (leave m))) z).
  { intros u z hz. pose proof (way_ok m (leave m) (arrive m) u z hz) as wk. rewrite ew in wk. rewrite wk. set (A := at_time m _ z). rewrite (surjective_pairing A).
    unfold scale; cbn [fst snd]. f_equal; field; lra. }
  assert (first : add (real x0) v = add (scale (/ Q2R f) (value2 (0 * y0) w)) v).
  { rewrite (on (0 * y0) 0) by (intros _; ring). rewrite ex. do 2 f_equal. ring. }
  assert (last : add (at_time m t s) v = add (scale (/ Q2R f) (value2 (1 * y0) w)) v).
  { rewrite Rmult_1_l, (on y0 s) by (intro e; symmetry; now apply le_). now rewrite lt. }
  rewrite last. rewrite first in bv. rewrite <- bv. symmetry. apply (odd_path es (fun u => add (scale (/ Q2R f) (value2 (u * y0) w)) v) cl (way_continuous w (Q2R f) y0 v l01 f0)).
  intros u hu. rewrite (on (u * y0) (u * y0)) by reflexivity. apply here; [|nra]. unfold under_way in ut |- *. nra.
Qed.
